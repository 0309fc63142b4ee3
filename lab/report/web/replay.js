'use strict';
/* The tracked models and the truth in 3D, to be turned and scrubbed. Shapes and motions as
   replay.hpp describes them: a motion carries every bone from the bind pose to the world. */

hypotrack.decodeShape = function (shape) {
  if (!shape.vertices) return {landmarks: shape.landmarks, edges: shape.edges};
  var geometry = new THREE.BufferGeometry();
  var indices = shape.triangles.bits === 16 ? hypotrack.words(shape.triangles.b)
                                            : hypotrack.longs(shape.triangles.b);
  geometry.setAttribute('position', new THREE.BufferAttribute(
      new Float32Array(hypotrack.numbers(shape.vertices)), 3));
  geometry.setAttribute('skinIndex', new THREE.BufferAttribute(hypotrack.words(shape.bones), 4));
  geometry.setAttribute('skinWeight', new THREE.BufferAttribute(
      hypotrack.bytes(shape.weights), 4, true));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  geometry.computeVertexNormals();
  return {geometry: geometry, landmarks: shape.landmarks, edges: shape.edges};
};

hypotrack.decodeMotion = function (motion) {
  if (motion.live) return motion;  // changes while it is shown
  if (motion.points !== undefined) return {points: motion.points, p: hypotrack.numbers(motion.p)};
  return {bones: motion.bones, q: new Int16Array(hypotrack.words(motion.q).buffer),
          t: hypotrack.numbers(motion.t)};
};

/** Sets `matrix` to what a motion does to a bone in a frame; false where that is not known. */
hypotrack.boneMatrix = function (motion, frame, bone, matrix) {
  var i = frame * motion.bones + bone, q = motion.q, t = motion.t;
  if (isNaN(t[3 * i])) return false;
  var rotation = new THREE.Quaternion(q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]);
  matrix.compose(new THREE.Vector3(t[3 * i], t[3 * i + 1], t[3 * i + 2]), rotation.normalize(),
                 new THREE.Vector3(1, 1, 1));
  return true;
};

/** World positions of a model's landmarks in a frame; NaN where not known, of which the
    constructor of Vector3 would make 0. */
hypotrack.landmarksAt = function (shape, motion, frame) {
  var matrix = new THREE.Matrix4();
  return shape.landmarks.map(function (landmark, k) {
    if (motion.points !== undefined) {
      var at = 3 * (frame * motion.points + k);
      return new THREE.Vector3().set(motion.p[at], motion.p[at + 1], motion.p[at + 2]);
    }
    var known = hypotrack.boneMatrix(motion, frame, landmark.bone, matrix);
    return known ? new THREE.Vector3().fromArray(landmark.p).applyMatrix4(matrix)
                 : new THREE.Vector3().set(NaN, NaN, NaN);
  });
};

/** A mesh that a motion moves. */
hypotrack.skinnedBody = function (shape, motion, look) {
  var material = new THREE.MeshPhongMaterial(Object.assign(
      {skinning: true, shininess: 12, side: THREE.DoubleSide}, look));
  var mesh = new THREE.SkinnedMesh(shape.geometry, material);
  var bones = [], inverses = [];
  for (var b = 0; b < motion.bones; b++) {
    var bone = new THREE.Bone();
    bone.matrixAutoUpdate = false;
    mesh.add(bone);
    bones.push(bone);
    inverses.push(new THREE.Matrix4());
  }
  mesh.frustumCulled = false;
  mesh.bind(new THREE.Skeleton(bones, inverses), new THREE.Matrix4());
  return {object: mesh, show: function (frame) {
    mesh.visible = bones.every(function (each, i) {
      each.matrixWorldNeedsUpdate = true;
      return hypotrack.boneMatrix(motion, frame, i, each.matrix);
    });
  }};
};

/** Landmarks joined by lines; `positions(frame)` gives their places. */
hypotrack.skeletonBody = function (count, edges, positions, color) {
  var points = new THREE.BufferGeometry(), lines = new THREE.BufferGeometry();
  points.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  lines.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6 * edges.length), 3));
  var object = new THREE.Group();
  object.add(new THREE.Points(points, new THREE.PointsMaterial(
      {color: color, size: 6, sizeAttenuation: false, depthTest: false})));
  object.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial(
      {color: color, depthTest: false})));
  object.children.forEach(function (child) { child.frustumCulled = false; child.renderOrder = 2; });
  function fill(geometry, places) {
    places.forEach(function (place, i) {
      geometry.attributes.position.setXYZ(i, place.x, place.y, place.z);
    });
    geometry.attributes.position.needsUpdate = true;
  }
  return {object: object, show: function (frame) {
    var known = function (place) { return !isNaN(place.x); };
    var places = positions(frame), ends = [];
    edges.forEach(function (edge) {
      var both = [places[edge[0]], places[edge[1]]];
      if (both.every(known)) ends = ends.concat(both);
    });
    var shown = places.filter(known);
    fill(points, shown);
    fill(lines, ends);
    points.setDrawRange(0, shown.length);
    lines.setDrawRange(0, ends.length);
  }};
};

/** Everything that moves in a replay, in groups that can be hidden. */
hypotrack.replayBodies = function (page, replay, colors) {
  var groups = {tracked: [], truth: [], skeleton: []};
  var all = [];
  replay.models.forEach(function (model) {
    var shape = hypotrack.decodeShape(page.shapes[model.shape]);
    ['tracked', 'truth'].forEach(function (role) {
      if (model[role] === undefined) return;
      var motion = hypotrack.decodeMotion(page.motions[model[role]]);
      var look = role === 'tracked' ? {color: colors.tracked}
          : {color: colors.truth, transparent: true, opacity: 0.42, depthWrite: false};
      if (shape.geometry) groups[role].push(hypotrack.skinnedBody(shape, motion, look));
      var places = function (frame) { return hypotrack.landmarksAt(shape, motion, frame); };
      groups[shape.geometry ? 'skeleton' : role].push(hypotrack.skeletonBody(
          shape.landmarks.length, shape.edges, places, colors[role]));
      if (role === 'tracked') all.push(places);
    });
  });
  if (replay.truth_points) groups.truth.push(hypotrack.truthPoints(page, replay, colors));
  return {groups: groups, places: function (frame) {
    return [].concat.apply([], all.map(function (places) { return places(frame); }));
  }};
};

/** True landmarks of all models, where the truth is no more than that. */
hypotrack.truthPoints = function (page, replay, colors) {
  var count = replay.truth_points.count, p = hypotrack.numbers(replay.truth_points.p);
  var edges = [], offset = 0;
  replay.models.forEach(function (model) {
    var shape = page.shapes[model.shape];
    shape.edges.forEach(function (edge) { edges.push([edge[0] + offset, edge[1] + offset]); });
    offset += shape.landmarks.length;
  });
  return hypotrack.skeletonBody(count, edges, function (frame) {
    return Array.from({length: count}, function (unused, i) {
      var at = 3 * (frame * count + i);
      return new THREE.Vector3().set(p[at], p[at + 1], p[at + 2]);
    });
  }, colors.truth);
};

/** The 3D view: {canvas, show(frame), resize(), setVisible(group, on), reset(), dispose()}; null
    without WebGL. */
hypotrack.stage = function (page, replay) {
  var canvas = hypotrack.element('canvas', {tabindex: '0', 'aria-label':
      'Tracked models and truth in 3D. Drag to turn, scroll to zoom, arrow keys to move.'});
  var context = canvas.getContext('webgl', {antialias: true, alpha: true});
  if (!context) return null;
  var style = getComputedStyle(document.documentElement);
  var colors = {tracked: style.getPropertyValue('--tracked').trim(),
                truth: style.getPropertyValue('--truth').trim()};
  var renderer = new THREE.WebGLRenderer({canvas: canvas, context: context, alpha: true});
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  var scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(35, 1, 0.005, 50);
  var world = new THREE.Group();
  world.rotation.x = Math.PI;  // from x right, y down, z forward
  scene.add(world, camera, new THREE.HemisphereLight(0xffffff, 0x667080, 0.75));
  var light = new THREE.DirectionalLight(0xffffff, 0.6);
  light.position.set(0.4, 0.8, 1);
  camera.add(light);
  var bodies = hypotrack.replayBodies(page, replay, colors);
  var groups = {};
  Object.keys(bodies.groups).forEach(function (name) {
    groups[name] = new THREE.Group();
    bodies.groups[name].forEach(function (body) { groups[name].add(body.object); });
    world.add(groups[name]);
  });
  var controls = new THREE.OrbitControls(camera, canvas);
  var pending = false;
  function draw() {
    if (pending) return;
    pending = true;
    requestAnimationFrame(function () { pending = false; renderer.render(scene, camera); });
  }
  controls.addEventListener('change', draw);
  function sphere(frame) {
    world.updateMatrixWorld(true);
    var places = bodies.places(frame).filter(function (place) { return !isNaN(place.x); });
    places.forEach(function (place) { place.applyMatrix4(world.matrixWorld); });
    return new THREE.Box3().setFromPoints(places).getBoundingSphere(new THREE.Sphere());
  }
  return {
    canvas: canvas, groups: bodies.groups,
    /** Shows a frame; the view goes along with the tracked models. */
    show: function (frame) {
      Object.keys(bodies.groups).forEach(function (name) {
        bodies.groups[name].forEach(function (body) { body.show(frame); });
      });
      var way = sphere(frame).center.sub(controls.target);
      camera.position.add(way);
      controls.target.add(way);
      controls.update();
      draw();
    },
    resize: function () {
      var width = canvas.parentNode.clientWidth, height = canvas.parentNode.clientHeight;
      if (!width || !height) return;
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      draw();
    },
    reset: function (frame) {
      var around = sphere(frame);
      controls.target.copy(around.center);
      // The skin reaches beyond the landmarks; a narrow view needs more distance.
      var distance = (3.7 * around.radius + 0.02) / Math.min(1, camera.aspect);
      camera.position.copy(around.center).add(new THREE.Vector3(0, 0, distance));
      controls.update();
      draw();
    },
    setVisible: function (name, on) { groups[name].visible = on; draw(); },
    dispose: function () { controls.dispose(); renderer.dispose(); renderer.forceContextLoss(); },
  };
};
