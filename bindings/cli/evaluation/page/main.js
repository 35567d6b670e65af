// Puts the page together and answers to its user.

const data = prepare(JSON.parse(document.getElementById("focal-data").textContent));
const renderer = createRenderer();
const byId = (id) => document.getElementById(id);
const state = { mesh: 0, name: null, turn: null, zoom: 1, up: data.up };
const cardsShown = 12, cardsOfOneMesh = 3; // or one flipped mesh would fill the list

function currentMesh() {
  return data.meshes[state.mesh];
}

function pointsOf(mesh, name) {
  const names = name === null ? Object.keys(mesh.found) : [name];
  return names.flatMap((n) => [mesh.marks[n], mesh.found[n]?.position]).filter(Boolean).map(mesh.surface().toPage);
}

function startingTurn(mesh, name) {
  if (name === null) return turnOf(0.45, 0.15, state.up);
  return turnTowards(mesh.surface(), pointsOf(mesh, name), state.up);
}

let drawingPlanned = false;
function redraw() {
  if (drawingPlanned) return;
  drawingPlanned = true;
  requestAnimationFrame(() => {
    drawingPlanned = false;
    drawPicture(renderer, byId("viewer"), currentMesh(), {
      turn: state.turn, zoom: state.zoom, name: state.name, votes: byId("show-votes").checked,
      marks: byId("show-marks").checked, names: byId("show-names").checked,
    });
    document.documentElement.dataset.drawn = `${currentMesh().name} ${state.name ?? "all"}`;
  });
}

function caseText(mesh, name) {
  const found = mesh.found[name], words = [];
  if (name in mesh.errors_edges) words.push(`${text(mesh.errors_edges[name] ?? Infinity)} edges off`);
  else words.push("not marked on this mesh");
  words.push(`${found.status}, confidence ${text(found.confidence)}`);
  if (found.expected_edges !== null) words.push(`expected error ${text(found.expected_edges)} edges`);
  if (mesh.swapped_names.includes(name)) words.push("left and right exchanged");
  return words.join("; ");
}

function viewerText() {
  const mesh = currentMesh(), parts = [];
  if (state.name === null) parts.push(`${mesh.name}: mean error ${text(mesh.mean)} edges, category fit ${percent(mesh.category_fit)}`);
  else parts.push(`${state.name} on ${mesh.name}: ${caseText(mesh, state.name)}`);
  if (mesh.shown.decimated) parts.push(`shown with ${mesh.shown.vertices.toLocaleString("en")} of ${mesh.vertices.toLocaleString("en")} vertices`);
  return `${parts.join(". ")}.`;
}

function show(meshIndex, name, keepTurn = false) {
  state.mesh = meshIndex;
  state.name = name;
  if (!keepTurn) {
    state.turn = startingTurn(currentMesh(), name);
    state.zoom = 1;
  }
  byId("mesh").value = String(meshIndex);
  byId("landmark").value = name ?? "";
  byId("viewer").setAttribute("aria-label", `Mesh ${currentMesh().name}, ${name === null ? "all landmarks" : `landmark ${name}`}`);
  byId("viewer-text").textContent = viewerText();
  byId("legend").classList.toggle("all", name === null);
  byId("cumulative").replaceChildren(cumulativeChart(data, name));
  for (const card of document.querySelectorAll("#worst button")) {
    card.setAttribute("aria-pressed", String(card.dataset.mesh === String(meshIndex) && card.dataset.name === name));
  }
  redraw();
}

function showAndGo(meshIndex, name) {
  show(meshIndex, name);
  byId("viewer").scrollIntoView({ block: "center", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
  byId("viewer").focus({ preventScroll: true });
}

// Step through the meshes, or through the landmarks with "all" as the first.
function stepMesh(by) {
  const count = data.meshes.length;
  show((state.mesh + by + count) % count, state.name);
}

function stepLandmark(by) {
  const names = [null, ...data.names];
  show(state.mesh, names[(names.indexOf(state.name) + by + names.length) % names.length]);
}

function turnBy(aroundY, aroundX) {
  state.turn = product(product(aboutX(aroundX), aboutY(aroundY)), state.turn);
  redraw();
}

function zoomBy(factor) {
  state.zoom = Math.min(20, Math.max(0.5, state.zoom * factor));
  redraw();
}

const keys = {
  ArrowLeft: () => turnBy(-0.15, 0), ArrowRight: () => turnBy(0.15, 0),
  ArrowUp: () => turnBy(0, -0.15), ArrowDown: () => turnBy(0, 0.15),
  "+": () => zoomBy(1.2), "=": () => zoomBy(1.2), "-": () => zoomBy(1 / 1.2),
  "[": () => stepMesh(-1), "]": () => stepMesh(1), ",": () => stepLandmark(-1), ".": () => stepLandmark(1),
  0: () => show(state.mesh, state.name), Home: () => show(state.mesh, state.name),
};

function listenToViewer() {
  const canvas = byId("viewer");
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) turnBy(event.movementX / 120, event.movementY / 120);
  });
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return; // or the page could not be scrolled past it
    event.preventDefault();
    zoomBy(Math.exp(-event.deltaY / 600));
  }, { passive: false });
}

function listenToControls() {
  byId("mesh").addEventListener("change", (event) => show(Number(event.target.value), state.name));
  byId("landmark").addEventListener("change", (event) => show(state.mesh, event.target.value || null));
  byId("mesh-back").addEventListener("click", () => stepMesh(-1));
  byId("mesh-next").addEventListener("click", () => stepMesh(1));
  byId("landmark-back").addEventListener("click", () => stepLandmark(-1));
  byId("landmark-next").addEventListener("click", () => stepLandmark(1));
  for (const id of ["show-votes", "show-marks", "show-names"]) byId(id).addEventListener("change", redraw);
  byId("up").addEventListener("change", (event) => {
    state.up = event.target.value;
    show(state.mesh, state.name);
    for (const card of document.querySelectorAll("#worst canvas")) drawCard(card);
  });
  const sides = { front: [0, 0.1], back: [Math.PI, 0.1], left: [-Math.PI / 2, 0.1], right: [Math.PI / 2, 0.1], top: [0, Math.PI / 2] };
  for (const [side, [yaw, pitch]] of Object.entries(sides)) {
    byId("sides").append(element("button", { type: "button", onclick: () => {
      state.turn = turnOf(yaw, pitch, state.up);
      redraw();
    } }, side));
  }
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

function drawCard(canvas) {
  const mesh = data.meshes[Number(canvas.dataset.mesh)], name = canvas.dataset.name;
  drawPicture(renderer, canvas, mesh, { turn: startingTurn(mesh, name), zoom: 1, name, votes: true, marks: true, names: false });
}

function worstCases() {
  const taken = new Map();
  const rank = data.cases.map((c) => {
    taken.set(c.index, (taken.get(c.index) ?? 0) + 1);
    return { ...c, later: taken.get(c.index) > cardsOfOneMesh };
  });
  return rank.filter((c) => !c.later).slice(0, cardsShown);
}

function fillWorst() {
  worstCases().forEach(({ index, name, error }) => {
    const mesh = data.meshes[index];
    const canvas = element("canvas", { "data-mesh": index, "data-name": name, "aria-hidden": "true" });
    byId("worst").append(element("li", {}, element("button",
      { type: "button", "data-mesh": index, "data-name": name, "aria-pressed": "false", title: caseText(mesh, name), onclick: () => show(index, name) },
      canvas, element("span", { class: "case" }, element("b", {}, name), ` on ${mesh.name}`),
      element("span", { class: `tint ${tintOf(error)}` }, `${text(error, 1)} edges`), // said in words and by tint
      element("span", { class: "sure" }, ` at confidence ${text(mesh.found[name].confidence)}`))));
  });
}

function fillFigures() {
  const c = data.calibration, flips = data.flipped_meshes;
  const figures = [
    ["mean error", text(data.mean_edges), `edges; ${text(data.mean_root_area_x100)} % of √area`],
    ["median error", text(data.median_edges), `edges; 95 % below ${text(data.p95_edges)}`],
    ["within 4 edges", percent(data.within_4_edges, 1), `over 10: ${percent(data.over_10_edges, 1)}`],
    ["flipped meshes", flips === null ? "–" : String(flips), flips === null ? "the set has no pairs" : `swapped: ${percent(data.swap_rate, 1)}`],
    ["calibration error", text(c.expected_calibration_error, 3), `AUROC ${text(c.auroc, 3)}`],
    ["sure and right", c.sure_count ? percent(c.sure_within_4_edges, 1) : "none", c.sure_count ? `of ${c.sure_count} with confidence ≥ 0.9` : "has confidence ≥ 0.9"],
    ["called absent", data.absent.precision === null ? "none" : `${percent(data.absent.precision)} right`,
      data.absent.recall === null ? "none truly is" : `recall ${percent(data.absent.recall)}`],
    ["category fit", percent(data.category_fit_median), `median; ${text(data.seconds_median)} s each`],
  ];
  for (const [title, value, more] of figures) {
    byId("figures").append(element("div", { class: "card" }, element("dt", {}, title), element("dd", {}, value), element("dd", { class: "more" }, more)));
  }
}

function calibrationText(calibration) {
  const sure = calibration.sure_count === 0 ? "no landmark has confidence 0.9 or more"
    : `of ${calibration.sure_count} landmarks with confidence 0.9 or more, ${percent(calibration.sure_within_4_edges, 1)} lie within 4 edges`;
  return `Expected calibration error ${text(calibration.expected_calibration_error, 3)}, AUROC ${text(calibration.auroc, 3)}; ${sure}.`;
}

function fillHead() {
  const title = `${data.set}: ${data.meshes.length} ${data.meshes.length === 1 ? "mesh" : "meshes"}, ${data.marks} marks`;
  document.title = `focal report: ${data.set}`;
  byId("title").textContent = title;
  byId("subtitle").textContent = `Model ${data.model}, preset ${data.preset}, quality ${data.quality}, split ${data.split}. ` +
    "Errors are distances between found and marked places in mean edge lengths of the mesh.";
  byId("footer").textContent = `Written by focal ${data.version}; drawn with ${renderer.name}. The page holds all it needs and loads nothing.`;
  data.meshes.forEach((mesh, i) => byId("mesh").append(element("option", { value: i }, `${mesh.name} (${text(mesh.mean)})`)));
  byId("landmark").append(element("option", { value: "" }, "all"), ...data.names.map((name) => element("option", { value: name }, name)));
  byId("up").value = state.up;
}

function fillRamp() {
  const canvas = byId("ramp"), context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = `rgb(${rampAt(x / (canvas.width - 1)).map((c) => Math.round(255 * c)).join()})`;
    context.fillRect(x, 0, 1, canvas.height);
  }
}

fillHead();
fillFigures();
fillRamp();
fillWorst();
listenToViewer();
listenToControls();
landmarkTable(byId("landmarks"), data, (name) => showAndGo(state.mesh, name));
meshTable(byId("meshes"), data, (index) => showAndGo(index, null));
errorGrid(byId("errors"), data, showAndGo);
byId("calibration").append(calibrationChart(data.calibration));
byId("calibration-text").textContent = calibrationText(data.calibration);
const first = data.cases[0];
show(first ? first.index : 0, first ? first.name : null);
for (const canvas of document.querySelectorAll("#worst canvas")) drawCard(canvas);
document.documentElement.dataset.renderer = renderer.name;
