// The robot: its surface, coloured by how far each vertex is displaced.
const shaded = gl && program(`
    layout(location = 0) in vec3 point; layout(location = 1) in vec3 normal; layout(location = 2) in vec4 colour;
    uniform mat4 camera; out vec3 n, p; out vec4 tint;
    void main() { n = normal; p = point; tint = colour; gl_Position = camera * vec4(p, 1.0); }`, LIT, ["camera", "eye", "light"]);

// From what is at rest to what is displaced most.
const RAMP = [[232, 217, 180], [235, 160, 70], [200, 62, 40], [105, 15, 75]];
const TINTS = Array.from({ length: 256 }, (_, i) => {
  const at = i / 255 * (RAMP.length - 1), k = Math.min(Math.floor(at), RAMP.length - 2);
  return RAMP[k].map((x, c) => x + (RAMP[k + 1][c] - x) * (at - k));
});

function normalsOf(v) {
  const out = new Float32Array(triangles.length);
  for (let f = 0; f < triangles.length; f += 3) {
    const [a, b, c] = [3 * triangles[f], 3 * triangles[f + 1], 3 * triangles[f + 2]];
    const [ux, uy, uz] = [v[b] - v[a], v[b + 1] - v[a + 1], v[b + 2] - v[a + 2]];
    const [wx, wy, wz] = [v[c] - v[a], v[c + 1] - v[a + 1], v[c + 2] - v[a + 2]];
    out[f] = uy * wz - uz * wy;
    out[f + 1] = uz * wx - ux * wz;
    out[f + 2] = ux * wy - uy * wx;
  }
  return out;
}
// Of every corner of a triangle, the triangles that make its normal: those about its vertex that lie flatly to its own in the
// first frame. And the lines: sharp edges, and all.
const SHARP = 0.4;
const [smooth, creases, mesh] = (() => {
  const n = normalsOf(verticesAt(0)), faces = triangles.length / 3;
  const normal = Array.from({ length: faces }, (_, f) => unit([n[3 * f], n[3 * f + 1], n[3 * f + 2]]));
  const about = Array.from({ length: count }, () => []), edges = new Map();
  for (let f = 0; f < faces; f++) for (let k = 0; k < 3; k++) {
    const [a, b] = [triangles[3 * f + k], triangles[3 * f + (k + 1) % 3]], key = Math.min(a, b) * count + Math.max(a, b);
    about[a].push(f);
    edges.set(key, [...edges.get(key) || [], f]);
  }
  const ends = (key) => [Math.floor(key / count), key % count];
  const isSharp = ([, met]) => met.length !== 2 || dot(normal[met[0]], normal[met[1]]) < SHARP;
  return [
    Array.from(triangles, (v, i) => about[v].filter((f) => dot(normal[Math.floor(i / 3)], normal[f]) > FLAT)),
    [...edges].filter(isSharp).flatMap(([key]) => ends(key)),
    [...edges.keys()].flatMap(ends),
  ];
})();

// The buffers of the place that is shown, made anew where it is another one.
const shape = { place: -1, points: null, lines: null, colours: null };
function shapeAt(place, corners) {
  if (shape.place === place && shape.corners === corners) return;
  const v = verticesAt(place), n = normalsOf(v), [a, b, t] = around(place);
  const points = new Float32Array(6 * triangles.length), colours = new Uint8Array(4 * triangles.length);
  triangles.forEach((vertex, i) => {
    let [x, y, z] = [0, 0, 0];
    for (const f of smooth[i]) { x += n[3 * f]; y += n[3 * f + 1]; z += n[3 * f + 2]; }
    points.set([v[3 * vertex], v[3 * vertex + 1], v[3 * vertex + 2], x, y, z], 6 * i);
    const far = moved[count * a + vertex] * (1 - t) + moved[count * b + vertex] * t;
    colours.set([...TINTS[Math.round(far)], 255], 4 * i);
  });
  const lines = new Float32Array(6 * corners.length);
  corners.forEach((vertex, i) => lines.set([v[3 * vertex], v[3 * vertex + 1], v[3 * vertex + 2], 0, 0, 0], 6 * i));
  for (const old of [shape.points, shape.colours, shape.lines && shape.lines.id]) if (old) gl.deleteBuffer(old);
  Object.assign(shape, { place, corners, points: filled(points), colours: filled(colours), lines: buffer(lines) });
}
function drawBody(camera, from, light) {
  const { made, at } = shaded;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform3f(at.eye, ...from);
  gl.uniform3f(at.light, ...light);
  attributes(shape.points, 24, [[0, 3, 0], [1, 3, 12]]);
  attributes(shape.colours, 4, [[2, 4, 0, 0, gl.UNSIGNED_BYTE]]);
  gl.drawArrays(gl.TRIANGLES, 0, triangles.length);
  noAttributes(2, 3);
}
