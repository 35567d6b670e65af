// The tables: landmarks, meshes, and every error as a grid.

// How bad an error is, said by number and by tint.
function tintOf(error) {
  return error === null || error === undefined ? "none" : error <= 2 ? "good" : error <= 4 ? "fair" : error <= 10 ? "poor" : "bad";
}

// columns: {title, value(row): sorted by, cell(row): a text or a node, start: column of words}
function sortableTable(table, caption, columns, rows, sortedBy) {
  const sorting = { column: sortedBy, descending: true };
  function fill() {
    const { value } = columns[sorting.column];
    const sign = sorting.descending ? -1 : 1;
    const sorted = [...rows].sort((a, b) => {
      const x = value(a), y = value(b);
      return sign * (typeof x === "string" ? x.localeCompare(y) : (x ?? -1) - (y ?? -1));
    });
    const heads = columns.map((column, i) => element("th",
      { scope: "col", class: column.start ? "start" : null,
        "aria-sort": i !== sorting.column ? null : sorting.descending ? "descending" : "ascending" },
      element("button", { type: "button", onclick: () => sort(i) }, column.title)));
    table.replaceChildren(element("caption", { class: "unseen" }, caption), element("thead", {}, element("tr", {}, ...heads)),
      element("tbody", {}, ...sorted.map((row) => element("tr", {}, ...columns.map((column, i) =>
        element(i === 0 ? "th" : "td", { scope: i === 0 ? "row" : null, class: column.start ? "start" : null },
          column.cell(row)))))));
  }
  function sort(column) {
    sorting.descending = column === sorting.column ? !sorting.descending : !columns[column].start;
    sorting.column = column;
    fill();
    table.querySelectorAll("thead button")[column].focus();
  }
  fill();
}

function tinted(error) {
  return element("span", { class: `tint ${tintOf(error)}` }, text(error));
}

function nameButton(name, choose) {
  return element("button", { type: "button", class: "link", onclick: choose }, name);
}

function landmarkTable(table, data, choose) {
  const number = (title, key, cell) => ({ title, value: (row) => row[key], cell: (row) => cell(row[key]) });
  sortableTable(table, "Errors of each landmark over all meshes", [
    { title: "landmark", start: true, value: (row) => row.name, cell: (row) => nameButton(row.name, () => choose(row.name)) },
    number("marks", "marks", String), number("mean", "mean_edges", tinted), number("median", "median_edges", text),
    number("95 %", "p95_edges", text), number("worst", "max_edges", text),
    number("within 4", "within_4_edges", percent), number("over 10", "over_10_edges", percent),
  ], data.landmarks, 2);
}

function meshTable(table, data, choose) {
  const number = (title, value, cell) => ({ title, value, cell: (mesh) => cell(value(mesh)) });
  sortableTable(table, "Every mesh", [
    { title: "mesh", start: true, value: (mesh) => mesh.name,
      cell: (mesh) => nameButton(mesh.name, () => choose(data.meshes.indexOf(mesh))) },
    number("mean", (mesh) => mesh.mean, tinted), number("worst", (mesh) => mesh.worst, text),
    { title: "where", start: true, value: (mesh) => mesh.worstName ?? "", cell: (mesh) => mesh.worstName ?? "–" },
    number("swapped", (mesh) => mesh.swapped, percent),
    number("flipped", (mesh) => mesh.flipped, (flipped) => (flipped === null ? "–" : flipped ? "yes" : "no")),
    number("category fit", (mesh) => mesh.category_fit, percent), number("vertices", (mesh) => mesh.vertices, (n) => n.toLocaleString("en")),
    number("seconds", (mesh) => mesh.seconds, text),
  ], data.meshes, 1);
}

// One stop for the tab key; the arrow keys move within.
function moveWithin(grid, event) {
  const steps = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] };
  const cell = event.target.closest("td");
  if (!cell || !steps[event.key]) return;
  const [down, right] = steps[event.key];
  const row = cell.parentElement.sectionRowIndex + down, column = cell.cellIndex + right;
  const next = grid.tBodies[0].rows[row]?.cells[column];
  event.preventDefault();
  if (!next || next.tagName !== "TD") return;
  cell.tabIndex = -1;
  next.tabIndex = 0;
  next.focus();
}

function errorGrid(table, data, choose) {
  const head = element("tr", {}, element("th", { scope: "col", class: "start" }, "mesh"),
    ...data.names.map((name) => element("th", { scope: "col", class: "slanted" }, element("span", {}, name))));
  const rows = data.meshes.map((mesh, index) => element("tr", {}, element("th", { scope: "row", class: "start" }, mesh.name),
    ...data.names.map((name) => {
      const marked = name in mesh.errors_edges, error = marked ? mesh.errors_edges[name] ?? Infinity : null;
      const absent = mesh.said_absent.includes(name);
      const cell = element("td", {
        class: `tint ${tintOf(error)}${absent ? " absent" : ""}`, tabindex: -1, onclick: () => choose(index, name),
        "aria-label": `${mesh.name}, ${name}: ${text(error)}${marked ? " edges" : ", not marked"}${absent ? ", said to be absent" : ""}`,
      }, error === null ? "–" : Number.isFinite(error) ? error.toFixed(1) : "∞");
      cell.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(index, name); }
      });
      return cell;
    })));
  table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...rows));
  table.addEventListener("keydown", (event) => moveWithin(table, event));
  const first = table.querySelector("td");
  if (first) first.tabIndex = 0;
}
