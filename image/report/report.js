// Draws what stands in `drawn`, in the page's figures in turn; `palette` has the colours of count maps.
const colours = ["#3060b8", "#d1662b", "#2c8a61", "#9a4fb0", "#b08a12", "#1694a6", "#c03a5b", "#6b7280"];
const shapes = ["circle", "triangle", "rect", "rectRot", "star", "crossRot"];
const short = new Intl.NumberFormat("en", {notation: "compact", maximumSignificantDigits: 3});
const whole = new Intl.NumberFormat("en", {maximumSignificantDigits: 5});

Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.color = "#5d6779";
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;

function axis(title, logarithmic, extra) {
  const decades = (value, index, ticks) => {
    const wide = ticks.length > 0 && ticks[ticks.length - 1].value / ticks[0].value > 100;
    const lead = Math.round(value / 10 ** Math.floor(Math.log10(value) + 1e-9));
    const round = Math.abs(value / 10 ** Math.floor(Math.log10(value) + 1e-9) - lead) < 1e-6;
    return round && (lead === 1 || (!wide && (lead === 2 || lead === 5))) ? short.format(value) : "";
  };
  const ticks = {callback: logarithmic ? decades : (value) => short.format(value), autoSkip: !logarithmic, maxRotation: 0};
  return {type: logarithmic ? "logarithmic" : "linear", title: {display: title !== "", text: title}, ticks,
          grid: {color: "#eceff4"}, ...extra};
}

// The ends of a logarithmic axis of all points, with a little room.
function around(datasets) {
  const values = datasets.flatMap((dataset) => dataset.data.map((p) => p.x));
  return {min: Math.min(...values) / 1.3, max: Math.max(...values) * 1.3};
}

function drawPlot(canvas, plot) {
  const bars = plot.kind === "bars" || plot.kind === "stacked";
  const stacked = plot.kind === "stacked";
  const shown = (p) => (!plot.logX || p[0] > 0) && (!plot.logY || p[1] > 0);
  const datasets = plot.series.map((series, i) => ({
    label: series.name,
    data: bars ? series.points.map((p) => p[1]) : series.points.filter(shown).map((p) => ({x: p[0], y: p[1]})),
    backgroundColor: colours[i % colours.length] + (bars ? "" : plot.kind === "points" ? "00" : "40"),
    borderColor: series.reference ? "#9aa3b2" : colours[i % colours.length],
    borderWidth: bars ? 0 : series.reference ? 1 : 1.8,
    borderDash: series.reference ? [5, 4] : [],
    pointStyle: series.reference ? "line" : shapes[i % shapes.length],
    pointRadius: series.reference ? 0 : 4.5,
    pointHoverRadius: series.reference ? 0 : 7,
    showLine: plot.kind === "lines" || series.reference,
    maxBarThickness: 46,
  }));
  const x = bars ? {title: {display: plot.x !== "", text: plot.x}, grid: {display: false}, stacked}
                 : axis(plot.x, plot.logX, plot.logX ? around(datasets) : {});
  const label = (item) => `${item.dataset.label}: ` +
      (bars ? whole.format(item.parsed.y) : `${whole.format(item.parsed.x)}, ${whole.format(item.parsed.y)}`);
  new Chart(canvas, {
    type: bars ? "bar" : "scatter",
    data: {labels: plot.categories, datasets},
    options: {
      scales: {x, y: axis(plot.y, plot.logY, {stacked, beginAtZero: true})},
      plugins: {
        legend: {display: datasets.length > 1, position: "bottom", labels: {usePointStyle: !bars, boxWidth: bars ? 12 : 8, boxHeight: bars ? 12 : 8}},
        tooltip: {callbacks: {label, ...(bars ? {} : {title: () => ""})}},
      },
    },
  });
}

function drawCounts(canvas, map) {
  const most = Math.max(1, ...map.counts);
  const colour = (count) => palette[Math.round(255 * Math.log1p(count) / Math.log1p(most))];
  canvas.width = map.width;
  canvas.height = map.height;
  const context = canvas.getContext("2d");
  const image = context.createImageData(map.width, map.height);
  map.counts.forEach((count, i) => image.data.set([...colour(count), 255], i * 4));
  context.putImageData(image, 0, 0);

  const box = canvas.parentElement;
  box.classList.add("counts");
  const scale = document.createElement("div");
  scale.className = "scale";
  scale.style.background = "linear-gradient(to top," + palette.map((c) => `rgb(${c})`).join() + ")";
  const marks = [0, ...[1, 10, 100, 1000, 1e4, 1e5, 1e6].filter((v) => v * 1.5 < most), most];
  for (const mark of marks) {
    const label = document.createElement("span");
    label.textContent = short.format(mark);
    label.style.bottom = `calc(${100 * Math.log1p(mark) / Math.log1p(most)}% - 1.4em)`;
    scale.append(label);
  }
  const under = document.createElement("div");
  under.className = "under";
  box.append(scale, under);
  canvas.addEventListener("mousemove", (event) => {
    const frame = canvas.getBoundingClientRect();
    const size = Math.min(frame.width / map.width, frame.height / map.height);
    const x = Math.floor((event.clientX - frame.left - (frame.width - size * map.width) / 2) / size);
    const y = Math.floor((event.clientY - frame.top - (frame.height - size * map.height) / 2) / size);
    const inside = x >= 0 && y >= 0 && x < map.width && y < map.height;
    under.textContent = inside ? `${x}, ${y}: ${whole.format(map.counts[y * map.width + x])} ${map.unit}` : "";
  });
  canvas.addEventListener("mouseleave", () => { under.textContent = ""; });
}

document.querySelectorAll("figure canvas").forEach((canvas, i) => {
  (drawn[i].kind === "counts" ? drawCounts : drawPlot)(canvas, drawn[i]);
});

// Of sizes; a number without one counts as it is.
const units = {KiB: 2 ** 10, MiB: 2 ** 20, GiB: 2 ** 30};

// Columns that hold words stand to the left; a click on a column's head sorts by it.
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  const numberOf = (row, column) => {
    const [number, unit] = row.cells[column].textContent.split(" ");
    return number === "-" ? -Infinity : parseFloat(number) * (units[unit] ?? 1);
  };
  heads.forEach((head, column) => {
    const words = [...body.rows].some((row) => Number.isNaN(numberOf(row, column)));
    if (words) for (const row of table.rows) row.cells[column].classList.add("text");
    let direction = -1;
    head.addEventListener("click", () => {
      direction = -direction;
      const compare = (a, b) => words ? a.cells[column].textContent.localeCompare(b.cells[column].textContent)
                                      : numberOf(a, column) - numberOf(b, column);
      body.append(...[...body.rows].sort((a, b) => direction * compare(a, b)));
    });
  });
}
