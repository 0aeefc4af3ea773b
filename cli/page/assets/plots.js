"use strict";
// What the steps cost, over the steps; Chart.js draws.

class Plots {
  /** `open(entry)` is called for the step that is clicked. */
  constructor(section, report, steps, labels, open) {
    Object.assign(this, { section, report, steps, open });
    this.charts = [];
    this.each = Math.max(1, Math.ceil(steps.length / Plots.mostPoints));
    this.entries = this.chosen();
    this.labels = this.entries.map((entry) => labels[entry]);
    document.addEventListener("scheme", () => this.charts.length > 0 && this.draw());
  }

  /** The entries that have a point: all, or of every few the one that took longest. */
  chosen() {
    const entries = [];
    this.steps.forEach((step, entry) => {
      const last = entries.length - 1;
      if (entry % this.each === 0) entries.push(entry);
      else if (step.seconds.total > this.steps[entries[last]].seconds.total) entries[last] = entry;
    });
    return entries;
  }

  column(read) {
    return this.entries.map((entry) => read(this.steps[entry]));
  }

  /** The plots: heading, what it says, kind, series of names and values. */
  all() {
    const full = this.report.full_render_seconds, isMeasured = this.steps.some((step) => fullSeconds(step, full));
    const stages = ["classify", "select", "test", "update", "evaluate", "write"];
    const kinds = [["ray_paths", "ray paths"], ["ray_trees", "ray trees"], ["sample_colors", "sample colours"], ["light_sums", "sums of light"], ["kept_rays", "kept rays"], ["kept_segments", "kept segments"],
      ["kept_terms", "kept terms"], ["kept_vertices", "kept vertices"], ["color_trees", "colour trees"],
      ["groups", "groups"], ["tunnels", "tunnels"]];
    const moves = ["evicted", "rebuilt", "reloaded"].map((what) => [what, this.column((step) => step[what].total)]);
    const shown = [
      { title: "Time by stage", text: "Seconds of each frame. Write: what the frame waits for.", kind: "stacked", unit: page.seconds,
        series: stages.map((stage) => [stage, this.column((step) => step.seconds[stage])]) },
      isMeasured ? { title: "Full render / step", text: "A full render of each step's own state, where that is known, against the step. Higher is better.",
        kind: "line", log: true, unit: (value) => `${Number(value.toPrecision(3))} x`,
        series: [["ratio", this.column((step) => (step.step > 0 && step.seconds.total > 0 ? fullSeconds(step, full) / step.seconds.total : null))]] }
        : { title: "Full render / step", text: "Not measured in this run: replay with --baseline or --verify.", series: [] },
      { title: "Rays", text: "Stored segments tested against the selection, those culled before, and rays shot again.", kind: "line", log: true, unit: page.count,
        series: [["tested", this.column((step) => step.ray_tests)], ["culled", this.column((step) => step.ray_tests_culled)],
          ["ray updates", this.column((step) => step.ray_updates)], ["shadow updates", this.column((step) => step.shadow_updates)]] },
      { title: "Memory by kind", text: "Bytes resident after each frame.", kind: "area", unit: page.bytes,
        series: kinds.map(([key, name]) => [name, this.column((step) => step.resident[key])]) },
      { title: "Pixels changed", text: "Of each frame; samples affected is what was looked at again.", kind: "line", log: true, unit: page.count,
        series: [["pixels changed", this.column((step) => step.pixels_changed)], ["samples affected", this.column((step) => step.samples_affected)]] },
    ];
    if (moves.some(([, values]) => values.some((bytes) => bytes > 0)))
      shown.push({ title: "Evictions", text: "Bytes that left memory, were worked out again, or were read back.", kind: "stacked",
        unit: page.bytes, series: moves });
    else shown.push({ title: "Evictions", text: "None: everything stayed in memory in this run.", series: [] });
    return shown;
  }

  draw() {
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    this.section.replaceChildren();
    if (this.each > 1)
      this.section.append(page.element("p", { className: "note" }, `Of every ${this.each} frames the one that took longest.`));
    for (const plot of this.all()) {
      const canvas = page.element("canvas", { role: "img", "aria-label": plot.title });
      const figure = page.element("div", { className: "plot" }, page.element("h2", {}, plot.title), page.element("p", {}, plot.text));
      this.section.append(figure);
      if (plot.series.length === 0) continue;
      figure.append(page.element("div", {}, canvas));
      this.charts.push(new Chart(canvas, this.config(plot)));
    }
  }

  config({ kind, log, unit, series }) {
    const isBar = kind === "stacked", isStacked = isBar || kind === "area";
    const text = page.color("soft"), line = page.color("line");
    const datasets = series.map(([label, values], i) => {
      const color = page.color(`series-${(i % 7) + 1}`);
      return {
        label, data: log ? values.map((value) => (value > 0 ? value : null)) : values, borderColor: color,
        backgroundColor: isStacked ? `${color}cc` : color, borderWidth: isBar ? 0 : 1.5, fill: kind === "area",
        pointRadius: this.labels.length > 80 ? 1 : 2.5, pointHitRadius: 6, spanGaps: false, maxBarThickness: 26,
      };
    });
    return {
      type: isBar ? "bar" : "line",
      data: { labels: this.labels, datasets },
      options: {
        animation: false, responsive: true, maintainAspectRatio: false,
        interaction: { mode: "index", intersect: false },
        onClick: (event, items) => items.length > 0 && this.open(this.entries[items[0].index]),
        scales: {
          x: { stacked: isStacked, ticks: { color: text, maxRotation: 0, autoSkip: true }, grid: { display: false } },
          y: { stacked: isStacked, type: log ? "logarithmic" : "linear", beginAtZero: true, grid: { color: line },
            ticks: { color: text, maxTicksLimit: 7, callback: (value) => unit(Number(value)) } },
        },
        plugins: {
          legend: { display: series.length > 1, labels: { color: text, boxWidth: 12, boxHeight: 12 } },
          tooltip: {
            callbacks: {
              title: (items) => this.title(items[0].dataIndex),
              label: (item) => `${item.dataset.label}: ${unit(item.raw ?? 0)}`,
            },
          },
        },
      },
    };
  }

  title(point) {
    return `${this.labels[point]} ${this.steps[this.entries[point]].name}`;
  }
}
Plots.mostPoints = 1000;
