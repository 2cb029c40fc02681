// Put before everything else of a page: notes every error, uses the controls as people do, and says what came of it in attributes
// of the root element.
const told = document.documentElement.dataset;
told.errors = "";
const note = (error) => { told.errors += error + "; "; };
addEventListener("error", (event) => note(event.message));
addEventListener("unhandledrejection", (event) => note(event.reason));
addEventListener("securitypolicyviolation", (event) => note("refused: " + event.violatedDirective + " " + event.blockedURI));
for (const kind of ["error", "warn"]) console[kind] = (...words) => note(words.join(" "));
// What was drawn stays, so that it can be read.
const context = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, options) {
  return context.call(this, kind, kind === "webgl2" ? { ...options, preserveDrawingBuffer: true } : options);
};
// The page has a clock of its own, which stands still unless the walk advances it: all that is waited for happens within the
// walk, however fast or slow the browser paints, and the walk is over when the page has loaded.
let clock = 0, frames = 0, lastTimer = 0, timers = [];
performance.now = () => clock;
window.setTimeout = (call, wait = 0) => {
  timers.push({ id: ++lastTimer, at: clock + wait, call });
  return lastTimer;
};
window.clearTimeout = (id) => { timers = timers.filter((timer) => timer.id !== id); };
window.requestAnimationFrame = (call) => setTimeout(() => { frames++; call(clock); }, 16);
const later = () => {
  const end = clock + 50;
  for (;;) {
    const due = timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at || a.id - b.id)[0];
    if (!due) break;
    clearTimeout(due.id);
    clock = Math.max(clock, due.at);
    due.call();
  }
  clock = end;
};
addEventListener("load", () => {
  const element = (id) => document.getElementById(id);
  const view = element("view");
  const coloured = () => {
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [view.width, view.height];
    const drawn = flat.getContext("2d");
    drawn.drawImage(view, 0, 0);
    const pixels = drawn.getImageData(0, 0, flat.width, flat.height).data;
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = [pixels[i], pixels[i + 1], pixels[i + 2]];
      if (Math.max(r, g, b) - Math.min(r, g, b) > 40) count++;
    }
    return count;
  };
  const point = (kind, x, y, more) => view.dispatchEvent(new PointerEvent(kind,
    { pointerId: 1, clientX: x, clientY: y, bubbles: true, ...more }));
  view.setPointerCapture = () => {};
  const choose = (id, value) => { element(id).value = value; element(id).dispatchEvent(new Event(element(id).type === "range" ? "input" : "change")); };
  try {
    later();
    told.drawn = coloured();
    // Points everywhere until a node is near.
    const title = () => document.querySelector("#values h1").textContent;
    let found = "";
    for (let y = 40; y < innerHeight - 100 && !found; y += 17) for (let x = 20; x < innerWidth && !found; x += 17) {
      point("pointermove", x, y);
      if (title().startsWith("node ")) found = [x, y];
    }
    told.pointed = title();
    later();
    told.robot = coloured();
    point("pointerdown", ...found, { button: 0, buttons: 1 });
    point("pointerup", ...found, { button: 0 });
    point("pointermove", 1, 1);
    told.clicked = title();
    const counts = element("counts").textContent;
    choose("stop", 0);
    later();
    told.grown = element("counts").textContent !== counts;
    told.first = coloured();
    choose("stop", element("stop").max);
    for (const option of [...element("colours").options]) {
      choose("colours", option.value);
      later();
    }
    told.legend = element("least").textContent + " to " + element("most").textContent;
    for (const id of ["show-robots", "show-edges", "show-nodes", "show-obstacles"]) element(id).click();
    later();
    const unturned = view.toDataURL();
    point("pointerdown", 300, 300, { button: 0, buttons: 1 });
    point("pointermove", 340, 300, { buttons: 1 });
    point("pointerup", 340, 300, { button: 0 });
    later();
    told.turned = view.toDataURL() !== unturned;
    element("home").click();
    choose("slider", 100);
    later();
    later();
    const before = frames;
    for (let i = 0; i < 10; i++) later();
    told.idle = frames - before;
    told.time = element("time").textContent;
    // A hint is drawn where the robot has a base that moves: dragged in the plane of the screen, turned, moved in depth.
    told.hint = "";
    if (!element("draw").hidden) {
      element("draw").click();
      later();
      const shown = view.toDataURL();
      const stroke = (more) => {
        point("pointerdown", 300, 300, { button: 0, buttons: 1, ...more });
        for (let by = 10; by <= 60; by += 10) point("pointermove", 300 + by, 300 - by / 2, { buttons: 1, ...more });
        point("pointerup", 360, 270, { button: 0, ...more });
      };
      stroke({});
      stroke({ shiftKey: true });
      view.dispatchEvent(new WheelEvent("wheel", { deltaY: 300, cancelable: true }));
      later();
      told.drawn = view.toDataURL() === shown ? 0 : told.drawn;
      const kept = element("drawn").textContent;
      stroke({});
      element("undo").click();
      told.undone = element("drawn").textContent === kept;
      // A click, and a drag that moves the view, keep nothing.
      point("pointerdown", 300, 300, { button: 0, buttons: 1 });
      point("pointerup", 300, 300, { button: 0 });
      stroke({ ctrlKey: true });
      told.kept = element("drawn").textContent === kept ? kept : "not " + kept;
      told.hint = hintText();
      told.poses = hint.kept[hint.kept.length - 1].poses.join(" ");
      told.widehint = document.documentElement.scrollWidth > innerWidth;
      element("save").click();
      element("clear").click();
      told.cleared = element("drawn").textContent;
      element("draw").click();
    }
    told.wide = document.documentElement.scrollWidth > innerWidth;
  } catch (error) { note(error.stack); }
  told.done = "yes";
});
