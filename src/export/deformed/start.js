// The controls, the chart, and what the address asks for: #frame=12&view=TURN,TILT,AWAY.
const placeNow = () => Number(element("frame").value);
const chart = document.querySelector("#energy svg"), cursor = chart.querySelector(".cursor");
const marks = cursor.dataset.places.split(" ").map((pair) => pair.split(",").map(Number));
const short = (x) => x === null ? "unknown" : String(+x.toPrecision(4));
function tell() {
  const place = placeNow(), [a, b, t] = around(place);
  const blend = (of) => of(a) + (of(b) - of(a)) * t;
  cursor.setAttribute("cx", blend((i) => marks[i][0]));
  cursor.setAttribute("cy", blend((i) => marks[i][1]));
  const [number, along, energy, volume] = data.told[Math.round(place)];
  element("told").textContent =
    `frame ${number} of ${data.all}, ${along} % of the path, energy ${short(energy)}, volume ${volume} % of that at rest`;
}
function show() {
  tell();
  repaint();
}
// A whole way takes about twelve seconds, however many frames it has.
const SECONDS = 12, TICK = 33;
const { begin, stop, toggle } = player(show, TICK, () => last * TICK / 1000 / SECONDS);
chart.addEventListener("click", (event) => {
  const { left, width } = chart.getBoundingClientRect();
  const x = (event.clientX - left) / width * chart.viewBox.baseVal.width;
  const nearest = marks.reduce((best, mark, i) => Math.abs(mark[0] - x) < Math.abs(marks[best][0] - x) ? i : best, 0);
  stop();
  element("frame").value = nearest;
  show();
});
for (const id of ["show-obstacles", "show-mesh"]) element(id).addEventListener("change", repaint);
// A path is longer than it is wide, so that the whole is seen from nearer as well.
const near = () => ({ ...home(), away: 0.78 });
eye = near();
element("home").addEventListener("click", () => { eye = near(); repaint(); });
element("ramp").style.background = `linear-gradient(to right,${RAMP.map((rgb) => `rgb(${rgb})`).join(",")})`;
element("largest").textContent = short(data.largest);
dark.addEventListener("change", repaint);
new ResizeObserver(repaint).observe(canvas);

begin(frames);
const asked = new Map(location.hash.slice(1).split("&").map((part) => part.split("=")));
const frame = Number(asked.get("frame"));
if (asked.has("frame") && Number.isFinite(frame)) element("frame").value = frame;
const [turn, tilt, away] = (asked.get("view") || "").split(",").map(Number);
if (asked.has("view") && [turn, tilt, away].every(Number.isFinite))
  Object.assign(eye, { turn, tilt: within(tilt, LIMITS.tilt), away: within(away, LIMITS.away) });
if (!gl) element("no-view").hidden = false;
// What moves by itself is played at once only for those who do not mind.
if (gl && !asked.has("frame") && last > 0 && !matchMedia("(prefers-reduced-motion: reduce)").matches) toggle();
show();
