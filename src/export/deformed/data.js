// What the page shows: the obstacles, and the vertices of the robot in every frame, in the world. `places` has whole numbers in 16
// bits, of which `unit` makes lengths from `origin` on; `moved` how far each vertex is displaced from its place at rest, 255
// for `largest`; `told` what is said of each frame.
const data = JSON.parse(element("data").textContent);
const triangles = column(data.triangles, Uint32Array);
const places = column(data.places, Uint16Array), moved = column(data.moved, Uint8Array);
const frames = data.told.length, count = moved.length / frames, last = frames - 1;

// The two frames around a place, and how far it is from the first to the second.
function around(place) {
  const from = Math.max(0, Math.min(Math.floor(place), last - 1));
  return [from, Math.min(from + 1, last), place - from];
}
// The vertices at a place. From one frame to the next each goes along a straight line.
function verticesAt(place) {
  const [a, b, t] = around(place), out = new Float32Array(3 * count);
  for (let i = 0; i < 3 * count; i++) {
    const [p, q] = [places[3 * count * a + i], places[3 * count * b + i]];
    out[i] = data.origin[i % 3] + data.unit[i % 3] * (p + (q - p) * t);
  }
  return out;
}
