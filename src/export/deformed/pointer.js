// The pointer, fingers and keys: dragging turns, shift or the right button moves, the wheel or two fingers zoom.
const fingers = new Map();
const spread = () => {
  const [a, b] = [...fingers.values()];
  return { apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1, at: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] };
};
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
});
canvas.addEventListener("pointermove", (event) => {
  const was = fingers.get(event.pointerId);
  if (!was) return;
  const old = fingers.size === 2 ? spread() : null, [x, y] = [event.clientX - was[0], event.clientY - was[1]];
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  if (old) {
    const { apart, at } = spread();
    zoomBy(old.apart / apart);
    moveBy(at[0] - old.at[0], at[1] - old.at[1]);
  } else if (event.shiftKey || event.buttons & 6) moveBy(x, y);
  else turnBy(x, y);
  repaint();
});
for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  zoomBy(Math.exp(event.deltaY * 0.001));
  repaint();
}, { passive: false });
const STEPS = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
canvas.addEventListener("keydown", (event) => {
  const step = STEPS[event.key];
  if (step) (event.shiftKey ? moveBy : turnBy)(...step);
  else if (event.key === "+" || event.key === "-") zoomBy(event.key === "+" ? 0.9 : 1 / 0.9);
  else if (event.key === " ") toggle();
  else return;
  event.preventDefault();
  repaint();
});
