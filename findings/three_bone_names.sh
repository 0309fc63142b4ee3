#!/usr/bin/env bash
# Rigs and exported motions are joined by the names of bones, and names such as hand.index 1 are
# common. The GLTFLoader of three.js drops dots and replaces spaces in names, and then renames a
# bone whose true name is what came out of another. Looking a bone up by its name finds none or a
# wrong one, and motion of the one lands on the other without a message.
set -euo pipefail

version=0.160.0
for program in node npm; do
  command -v "$program" >/dev/null || { echo "missing: $program" && exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
npm install --prefix "$folder" --no-audit --ignore-scripts "three@$version" >"$folder/log" 2>&1 ||
  { echo "missing: three@$version of the npm registry" && exit 77; }
echo "three $version, node $(node --version)"
cat >"$folder/main.mjs" <<'END'
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

globalThis.self = globalThis; // the loader asks for it

// Two bones: one 1 m and one 2 m along x.
const nodes = [
  { name: 'hand.index 1', translation: [1, 0, 0] },
  { name: 'handindex_1', translation: [2, 0, 0] },
];
const file = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0, 1] }], nodes };
const scene = await new Promise((loaded, failed) =>
  new GLTFLoader().parse(JSON.stringify(file), '', (gltf) => loaded(gltf.scene), failed));

const found = nodes.map(({ name }) => scene.getObjectByName(name)?.position.x);
console.log(`expected: ${nodes[0].name} is at 1, ${nodes[1].name} at 2`);
console.log(`seen:     ${nodes[0].name} is at ${found[0]}, ${nodes[1].name} at ${found[1]}; ` +
  `the names are ${scene.children.map((node) => node.name).join(', ')}`);
process.exit(found[0] === undefined && found[1] === 1 ? 0 : 1);
END
node "$folder/main.mjs"
