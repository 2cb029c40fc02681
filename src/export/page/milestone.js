// The robot at nodes: at the one that is pointed at, and small at many.
const pointed = () => {
  const node = state.hovered >= 0 ? state.hovered : state.chosen;
  return node < stopped().shownNodes ? node : -1;
};
function posesOf(node) {
  const count = data.links.length, { poses } = graph;
  return data.links.map((_, link) => {
    const p = poses.subarray(7 * (count * node + link), 7 * (count * node + link) + 7);
    return placed(p.subarray(0, 3), p.subarray(3, 7));
  });
}
const markerOf = (node) => graph.markers.subarray(3 * node, 3 * node + 3);

// The node's edges and a ring around it, over everything.
function drawPointed(camera) {
  const node = pointed();
  if (node < 0) return;
  const { pairs } = graph, { shownEdges } = stopped(), ends = [...markerOf(node)], tint = [...WAY.map((x) => 255 * x), 255];
  if (element("show-edges").checked) for (let edge = 0; edge < shownEdges; edge++) {
    const [a, b] = [pairs[2 * edge], pairs[2 * edge + 1]];
    if (a === node || b === node) ends.push(...markerOf(a), ...markerOf(b));
  }
  const points = filled(new Float32Array(ends));
  const colours = filled(new Uint8Array(ends.flatMap((_, i) => i % 3 ? [] : tint)));
  const at = useGraph(camera);
  attributes(points, 12, [[0, 3, 0]]);
  attributes(colours, 4, [[1, 4, 0, 0, gl.UNSIGNED_BYTE]]);
  gl.uniform1f(at.opacity, 0.9);
  gl.uniform1i(at.dots, 0);
  gl.drawArrays(gl.LINES, 1, ends.length / 3 - 1);
  gl.deleteBuffer(points);
  gl.deleteBuffer(colours);
  drawDots(camera, [[...markerOf(node)]], [tint], 11);
}

// Small robots: as many as can be drawn quickly, evenly over the nodes of the stop.
const ROBOTS_MAX = 1500, TRIANGLES_MAX = 600000;
const robotTriangles = gl ? scene.links.reduce((sum, link) => sum + link.faces.count / 3, 0) : 0;
const crowdCount = () =>
  Math.min(stopped().shownNodes, ROBOTS_MAX, Math.max(1, Math.floor(TRIANGLES_MAX / (robotTriangles || 1))));

// By how much the robot is made smaller, so that it is about a fortieth of the scene.
let smallerBy = null;
function smaller() {
  if (smallerBy !== null) return smallerBy;
  let reach = 0;
  const models = posesOf(0), marker = markerOf(0);
  data.links.forEach((bodies, link) => {
    const m = models[link];
    for (const { v } of bodies) for (let i = 0; i < v.length; i += 3) {
      const at = [0, 1, 2].map((k) => m[k] * v[i] + m[4 + k] * v[i + 1] + m[8 + k] * v[i + 2] + m[12 + k]);
      reach = Math.max(reach, Math.hypot(...sub(at, marker)));
    }
  });
  return smallerBy = Math.min(1, size / 80 / (reach || 1));
}
function drawCrowd(camera, from, light) {
  if (!graph || !element("show-robots").checked || !data.links.length || !stopped().shownNodes) return;
  const count = crowdCount(), { shownNodes } = stopped(), links = data.links.length;
  const { made, at } = programs.crowd;
  gl.useProgram(made);
  gl.uniformMatrix4fv(at.camera, false, camera);
  gl.uniform1f(at.smaller, smaller());
  gl.uniform3f(at.eye, ...from);
  gl.uniform3f(at.light, ...light);
  const nodes = Array.from({ length: count }, (_, i) => Math.floor(i * shownNodes / count));
  const tints = new Uint8Array(nodes.flatMap((node) => [...web.tints.subarray(4 * node, 4 * node + 4)]));
  const colours = filled(tints);
  for (let link = 0; link < links; link++) {
    const frames = new Float32Array(10 * count);
    nodes.forEach((node, i) => {
      const first = 7 * (links * node + link);
      frames.set(graph.poses.subarray(first, first + 7), 10 * i);
      frames.set(markerOf(node), 10 * i + 7);
    });
    const places = filled(frames);
    attributes(scene.links[link].faces.id, 24, [[0, 3, 0], [1, 3, 12]]);
    attributes(places, 40, [[2, 3, 0, 1], [3, 4, 12, 1], [4, 3, 28, 1]]);
    attributes(colours, 4, [[5, 4, 0, 1, gl.UNSIGNED_BYTE]]);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, scene.links[link].faces.count, count);
    gl.deleteBuffer(places);
  }
  gl.deleteBuffer(colours);
  noAttributes(2, 6);
}
