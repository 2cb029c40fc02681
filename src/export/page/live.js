// Following a build: whoever serves the page is asked for newer data until the build has ended.
const PAUSE = 1500;
async function follow() {
  try {
    const answer = await fetch("data?known=" + data.live.version, { cache: "no-store" });
    if (answer.status === 200) take(await answer.json());
    else if (answer.status !== 204) throw new Error();
    element("live").textContent = data.live.ended ? "The build has ended." : "Following the build.";
  } catch {
    element("live").textContent = "Whoever served this page has ended.";
    return;
  }
  if (!data.live.ended) setTimeout(follow, PAUSE);
}
// The scene stays as it is; who looked at the last round goes on to the new last one.
function take(newer) {
  const wasLast = state.stop === graph.stops.length - 1, share = state.place / (last() || 1);
  data = newer;
  graph = decoded(data.roadmap);
  if (wasLast || state.stop >= graph.stops.length) state.stop = graph.stops.length - 1;
  state.path = Math.max(0, Math.min(state.path, data.paths.length - 1));
  state.place = share * last();
  state.hovered = -1;
  if (state.chosen >= graph.count) state.chosen = -1;
  smallerBy = null;
  if (gl) { loadPaths(); loadRoadmap(); }
  fillControls();
  tellAll();
}
element("live").hidden = !data.live;
if (data.live) follow();
