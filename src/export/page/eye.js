// The eye: where it stands, and how it sees.
const home = () => ({ turn: planar ? -Math.PI / 2 : -1.15, tilt: planar ? Math.PI / 2 : 0.5, away: 1, at: [...middle] });
let eye = home();
// The field of view in radians; a plane is seen nearly without perspective. The picture stands a little higher, above the bar.
const FIELD = planar ? 0.06 : 0.55, RAISED = -0.07;
// In the plane what is behind a panel cannot be seen by turning: where the page is wide, the picture stands between the panels.
// Pixels of the page at its left and right that are theirs, at most half of it.
const PANELS = [282, 212], NARROW = 640;
function beside() {
  const wide = canvas.clientWidth;
  if (!planar || wide <= NARROW) return [0, 0];
  return PANELS.map((taken) => taken * Math.min(1 / wide, 0.5 / (PANELS[0] + PANELS[1])));
}
function look() {
  const aspect = (canvas.width || 1) / (canvas.height || 1);
  const toward = [Math.cos(eye.tilt) * Math.cos(eye.turn), Math.cos(eye.tilt) * Math.sin(eye.turn),
    Math.sin(eye.tilt)];
  const right = [-Math.sin(eye.turn), Math.cos(eye.turn), 0], up = cross(toward, right);
  // Far enough that all corners of what there is are seen.
  const f = 1 / Math.tan(FIELD / 2);
  const [takenLeft, takenRight] = beside(), free = 1 - takenLeft - takenRight;
  let fit = 0;
  for (let i = 0; i < 8; i++) {
    const p = sub([(i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]], middle);
    const wide = Math.max(Math.abs(dot(p, right)) / (aspect * free), Math.abs(dot(p, up)) * 1.2);
    fit = Math.max(fit, dot(p, toward) + wide * f * 1.06);
  }
  const away = Math.max(fit, size * 0.01) * eye.away;
  const from = eye.at.map((x, i) => x + toward[i] * away);
  const [near, far] = [Math.max(away - 1.5 * size, away * 0.01), away + 1.5 * size];
  const projection = new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, takenRight - takenLeft, RAISED,
    (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
  const view = new Float32Array([right[0], up[0], toward[0], 0, right[1], up[1], toward[1], 0,
    right[2], up[2], toward[2], 0, -dot(right, from), -dot(up, from), -dot(toward, from), 1]);
  return { camera: times(projection, view), from, right, up, toward, away };
}
const LIMITS = { away: [0.02, 8], tilt: [-1.55, planar ? Math.PI / 2 : 1.55] };
const within = (x, [least, most]) => Math.max(least, Math.min(most, x));
function turnBy(x, y) {
  eye.turn -= x * 0.008;
  eye.tilt = within(eye.tilt + y * 0.008, LIMITS.tilt);
}
// Pixels of the page.
function moveBy(x, y) {
  const { right, up, away } = look();
  const by = 2 * away * Math.tan(FIELD / 2) / canvas.clientHeight;
  eye.at = eye.at.map((value, i) => value + (up[i] * y - right[i] * x) * by);
}
const zoomBy = (factor) => { eye.away = within(eye.away * factor, LIMITS.away); };
