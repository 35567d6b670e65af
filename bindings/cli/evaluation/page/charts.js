// Charts as SVG: the cumulative error curves and the calibration plot.

const chart = { width: 520, height: 320, left: 44, right: 12, top: 12, bottom: 40 };

function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function axes(limit, ticks, xLabel, yLabel, xText) {
  const { width, height, left, right, top, bottom } = chart;
  const x = (value) => left + (value / limit) * (width - left - right);
  const y = (share) => height - bottom - share * (height - top - bottom);
  const group = svg("g", { class: "axes" });
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    group.append(svg("line", { x1: left, x2: width - right, y1: y(share), y2: y(share) }),
      svg("text", { x: left - 6, y: y(share) + 4, "text-anchor": "end" }, `${100 * share}`));
  }
  for (const tick of ticks) {
    group.append(svg("line", { x1: x(tick), x2: x(tick), y1: height - bottom, y2: height - bottom + 4 }),
      svg("text", { x: x(tick), y: height - bottom + 17, "text-anchor": "middle" }, xText(tick)));
  }
  group.append(svg("text", { x: (left + width - right) / 2, y: height - 5, "text-anchor": "middle" }, xLabel),
    svg("text", { transform: `translate(11 ${(top + height - bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, yLabel));
  return { x, y, group };
}

function chartFrame(label, ...children) {
  return svg("svg", { viewBox: `0 0 ${chart.width} ${chart.height}`, role: "img", "aria-label": label, class: "chart" },
    ...children);
}

// A step for each error: the share of the marks that are at most so far off.
function stepPath(errors, x, y, limit) {
  let path = `M${x(0)} ${y(0)}`;
  errors.forEach((error, i) => {
    if (error <= limit) path += `H${x(error).toFixed(1)}V${y((i + 1) / errors.length).toFixed(1)}`;
  });
  return `${path}H${x(limit)}`;
}

function errorsOf(data, name) {
  return data.cases.filter((c) => name === null || c.name === name).map((c) => c.error).sort((a, b) => a - b);
}

function shareWithin(errors, limit) {
  return errors.filter((error) => error <= limit).length / errors.length;
}

function cumulativeChart(data, chosen) {
  const all = errorsOf(data, null);
  if (!all.length) return element("p", {}, "No mark to measure from.");
  const last = all[Math.min(all.length - 1, Math.floor(0.985 * all.length))];
  const limit = Math.min(Math.max(4, Math.ceil(Number.isFinite(last) ? last : 12)), 40);
  const step = limit <= 10 ? 1 : limit <= 20 ? 2 : 5;
  const ticks = Array.from({ length: Math.floor(limit / step) + 1 }, (_, i) => i * step);
  const { x, y, group } = axes(limit, ticks, "error in edges", "% of marks", String);
  const lines = data.names.map((name) =>
    svg("path", { class: "thin", d: stepPath(errorsOf(data, name), x, y, limit) }, svg("title", {}, name)));
  const overall = svg("path", { class: "thick", d: stepPath(all, x, y, limit) });
  const top = chosen === null ? [] : [svg("path", { class: "chosen", d: stepPath(errorsOf(data, chosen), x, y, limit) })];
  const label = `Cumulative error: ${percent(shareWithin(all, 2))} of marks within 2 edges, ` +
    `${percent(shareWithin(all, 4))} within 4, ${percent(shareWithin(all, 10))} within 10.` +
    (chosen === null ? "" : ` ${chosen}: ${percent(shareWithin(errorsOf(data, chosen), 4))} within 4.`);
  const key = chosen === null ? [] : [svg("text", { class: "chosen-name", x: chart.width - 18, y: y(0) - 10, "text-anchor": "end" }, chosen)];
  return chartFrame(label, group, ...lines, overall, ...top, ...key);
}

function calibrationChart(calibration) {
  const ticks = [0, 0.2, 0.4, 0.6, 0.8, 1];
  const { x, y, group } = axes(1, ticks, "confidence", "% within 4 edges", (t) => t.toFixed(1));
  const most = Math.max(1, ...calibration.bins.map((bin) => bin.count));
  const bars = calibration.bins.map((bin) => {
    const height = (0.28 * bin.count) / most;
    return svg("rect", { class: "bar", x: x(bin.from) + 2, width: x(bin.to) - x(bin.from) - 4, y: y(height), height: y(0) - y(height) },
      svg("title", {}, `${bin.count} landmarks with confidence ${bin.from} to ${bin.to}`));
  });
  const filled = calibration.bins.filter((bin) => bin.count > 0);
  const path = filled.map((bin, i) => `${i ? "L" : "M"}${x(bin.confidence)} ${y(bin.accuracy)}`).join("");
  const points = filled.map((bin) =>
    svg("circle", { class: "point", cx: x(bin.confidence), cy: y(bin.accuracy), r: 3 + 5 * Math.sqrt(bin.count / most) },
      svg("title", {}, `confidence ${text(bin.confidence)}: ${percent(bin.accuracy)} of ${bin.count} within 4 edges`)));
  const label = "Calibration: " + filled.map((bin) =>
    `confidence ${text(bin.confidence)}, ${percent(bin.accuracy)} of ${bin.count} within 4 edges`).join("; ");
  return chartFrame(label, group, ...bars, svg("line", { class: "ideal", x1: x(0), y1: y(0), x2: x(1), y2: y(1) }),
    svg("path", { class: "chosen", d: path }), ...points);
}
