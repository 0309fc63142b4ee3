// bvh_positions.js FOLDER FILE: prints where three.js puts the joints of a BVH file, as JSON: for
// every frame an object of positions by name. FOLDER is that of three.js.
"use strict";
var fs = require("fs"), vm = require("vm"), folder = process.argv[2];
// Browsers load these files into one global scope, too.
["build/three.js", "examples/js/loaders/BVHLoader.js"].forEach(function (name) {
  vm.runInThisContext("(function () { var exports, module, define;" +
                      fs.readFileSync(folder + "/" + name, "utf8") + "}).call(globalThis)");
});
var THREE = globalThis.THREE;
var bvh = new THREE.BVHLoader().parse(fs.readFileSync(process.argv[3], "utf8"));
var top = new THREE.Object3D();
top.add(bvh.skeleton.bones[0]);
top.skeleton = bvh.skeleton;  // the tracks name its bones
var mixer = new THREE.AnimationMixer(top);
mixer.clipAction(bvh.clip).play();
var times = bvh.clip.tracks[0].times;
console.log(JSON.stringify(Array.from(times).map(function (time) {
  // Just before the end the action does not yet begin again.
  mixer.setTime(time === times[times.length - 1] ? time * (1 - 1e-6) : time);
  top.updateMatrixWorld(true);
  var positions = {};
  bvh.skeleton.bones.forEach(function (bone) {
    if (bone.name !== "ENDSITE")
      positions[bone.name] = new THREE.Vector3().setFromMatrixPosition(bone.matrixWorld).toArray();
  });
  return positions;
})));
