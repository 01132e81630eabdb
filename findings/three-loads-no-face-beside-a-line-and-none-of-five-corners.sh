#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: three.js loads the faces of a valid OBJ or PLY file as a mesh, or says that it did not. A line in an OBJ
# object becomes a line beside the mesh, and a polygon of a PLY file becomes triangles, as one of an OBJ file does.
# Seen: one "l" or "p" in an object or group makes all of it a LineSegments or Points in OBJLoader. A cube of 6 faces
# with one line has no mesh: the 36 corners of its triangles and the ends of the line go in pairs as segments, and a ray
# at the cube hits nothing. With the line in an object of its own, the cube stays a mesh. PLYLoader keeps faces of 3 and
# 4 corners and drops the others: a prism over a pentagon loads without its two ends, with an area of 11.76 for 16.51,
# and a file of the ends alone loads without an index. OBJLoader makes all their triangles. Nothing is thrown or logged.
# Seen with three 0.187.0 on Node 20 on 2026-11-30. Needs Node 20 or newer with npm, and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
trap 'rm -rf "$folder"' EXIT
if ! npm --version >/dev/null 2>&1 || [[ $(node -p 'parseInt(process.versions.node)') -lt 20 ]]; then
    fail "needs Node 20 or newer, and npm"
fi
cd "$folder"
echo '{"private": true}' >package.json
npm install --silent --no-audit --no-fund --ignore-scripts three@0.187.0

cat >load.mjs <<'END'
import * as THREE from 'three';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';

let messages = 0;
const say = console.log;
for (const name of ['log', 'info', 'warn', 'error']) console[name] = () => ++messages;

function obj({ points, faces }) {
    const lines = [...points.map(p => ['v', ...p]), ...faces.map(f => ['f', ...f.map(i => i + 1)])];
    return lines.map(words => words.join(' ') + '\n').join('');
}
function ply({ points, faces }) {
    const lines = [['ply'], ['format ascii 1.0'], ['element vertex', points.length], ['property float x'],
        ['property float y'], ['property float z'], ['element face', faces.length],
        ['property list uchar int vertex_indices'], ['end_header'], ...points, ...faces.map(f => [f.length, ...f])];
    return lines.map(words => words.join(' ') + '\n').join('');
}
function area(geometry) {
    const corners = (geometry.index ? geometry.toNonIndexed() : geometry).attributes.position;
    let sum = 0;
    for (let i = 0; i < corners.count; i += 3) {
        sum += new THREE.Triangle().setFromAttributeAndIndices(corners, i, i + 1, i + 2).getArea();
    }
    return sum.toFixed(2);
}

const cube = {
    points: [0, 1, 2, 3, 4, 5, 6, 7].map(i => [i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]),
    faces: [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
};
const ray = new THREE.Raycaster(new THREE.Vector3(0.1, 0.2, 5), new THREE.Vector3(0, 0, -1));
ray.params.Line.threshold = ray.params.Points.threshold = 0;
for (const [name, text] of Object.entries({
    alone: obj(cube), line: obj(cube) + 'l 1 8\n', point: obj(cube) + 'p 1\n',
    between: obj(cube).replace('f ', 'l 1 8\nf '),
    apart: 'o cube\n' + obj(cube) + 'o line\nl 1 8\n',
})) {
    const group = new OBJLoader().parse(text);
    const parts = group.children.map(child => `${child.type} ${child.geometry.attributes.position.count}`);
    say(`${name}|${parts.join(', ')}|${ray.intersectObject(group).length}`);
}

const ring = [0, 1, 2, 3, 4];
const points = [-1, 1].flatMap(z => ring.map(i => [Math.cos(i * Math.PI * 0.4), Math.sin(i * Math.PI * 0.4), z]));
const ends = [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9]], sides = ring.map(i => [i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5]);
for (const [name, faces] of Object.entries({ prism: [...ends, ...sides], ends })) {
    const byObj = new OBJLoader().parse(obj({ points, faces })).children[0].geometry;
    const byPly = new PLYLoader().parse(ply({ points, faces }));
    const ofPly = byPly.index ? `${byPly.index.count / 3}|${area(byPly)}` : 'no index|none';
    say(`${name}|${byObj.attributes.position.count / 3}|${area(byObj)}|${ofPly}`);
}
say(`messages|${messages}`);
END
node load.mjs >results
column() { grep "^$1|" results | cut -d'|' -f"$2"; }
same "OBJ: a cube" "$(column alone 2)" "Mesh 36"
same "hits of a ray" "$(column alone 3)" 1
same "OBJ: a cube, then a line" "$(column line 2)" "LineSegments 38"
same "hits of a ray" "$(column line 3)" 0
same "OBJ: a line before the faces" "$(column between 2)" "LineSegments 38"
same "hits of a ray" "$(column between 3)" 0
same "OBJ: a cube, then a point" "$(column point 2)" "Points 37"
same "hits of a ray" "$(column point 3)" 0
same "OBJ: a cube, then an object that is a line" "$(column apart 2)" "Mesh 36, LineSegments 2"
same "hits of a ray" "$(column apart 3)" 1
same "prism over a pentagon, OBJ: triangles" "$(column prism 2)" 16
same "area" "$(column prism 3)" 16.51
same "the same, PLY: triangles" "$(column prism 4)" 10
same "area" "$(column prism 5)" 11.76
same "its ends alone, OBJ: triangles" "$(column ends 2)" 6
same "area" "$(column ends 3)" 4.76
same "the same, PLY: triangles" "$(column ends 4)" "no index"
same "messages logged" "$(column messages 2)" 0
conclude
