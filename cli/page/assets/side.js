"use strict";
// What stands beside a frame. For review: its name, the change in words, the values of a wedge, notes. For engineering:
// its class and why, the edit as it is written, what it cost. And the part about the run.

/** A heading and what is below it. */
function under(heading, ...content) {
  return [page.element("h3", {}, heading), ...content];
}

function list(texts) {
  return page.element("ul", {}, ...texts.map((text) => page.element("li", {}, text)));
}

/** `details`: of StepDetails; null while they are not there yet. `open(entry)`: for the steps that it starts from. */
function stepParts(data, entry, details, open) {
  const step = data.steps[entry], parts = [page.element("h2", { id: "step-name" }, data.name(entry))];
  const above = [];
  for (let item = data.items[data.itemOf[entry]].parent; item && above.length < 4; item = item.parent) above.unshift(item);
  if (data.hasTree && above.length > 0)
    parts.push(page.element("p", { className: "path" }, "from ", ...above.flatMap((item, i) => [...(i > 0 ? [" › "] : []),
      page.button(data.steps[item.entry].name, () => open(item.entry), { className: "plain" })])));
  const values = data.values(entry), axes = data.axes(data.items[data.itemOf[entry]]);
  if (values.length > 0 && step.place > 0)
    parts.push(page.table(values.map((text, i) => [(values.length === axes.length ? axes[i] : data.steps[entry].axes?.[i])?.label ?? "value", text])));
  const changes = details?.edit?.map((operation) => words.operation(operation, words.short)) ?? data.changes(entry);
  if (changes.length > 0) parts.push(...under("Change", list(changes)));
  else if (step.step === 0) parts.push(page.element("p", { className: "soft" }, "The scene before any step."));
  if (data.isUnchanged(data.items[data.itemOf[entry]])) parts.push(page.element("p", { className: "soft" }, "No pixel is another one."));
  const note = details?.note ?? step.note;
  if (note || step.author)
    parts.push(...under(step.author ? `Journal: ${step.author}` : "Journal", page.element("p", { className: "journal-words" }, note ?? "")));
  parts.push(...fileLinks(data.report, step));
  return parts;
}

/** Links to the files beside the page, to open and to download; of a page of one file the names of what it lacks. */
function fileLinks(report, step) {
  const files = [["EXR", step.frame], ["preview", step.preview], ["report.json", "report.json"], ["journal", report.journal_url]];
  const known = files.filter(([, file]) => file);
  if (report.single)
    return [page.element("p", { className: "soft" }, `Not in this page, but in the run's folder: ${step.frame}, ${step.preview}, report.json.`)];
  const links = known.flatMap(([name, file]) => [page.element("a", { href: file, target: "_blank", rel: "noopener" }, `Open ${name}`), " ",
    page.element("a", { href: file, download: "", "aria-label": `Download ${name}`, title: `Download ${name}` }, "\u2193"), " "]);
  return [page.element("p", { className: "links" }, ...links)];
}

function engineeringParts(step, details, report) {
  const parts = [...under("Class", page.element("span", { className: `chip ${step.class}` }, step.class))];
  if (details?.reasons) parts.push(...under("Why this class", list(details.reasons)));
  if (details?.select) parts.push(...under("Selection", list(details.select)));
  if (details?.edit) parts.push(...under("The edit", page.element("pre", { tabIndex: 0 }, words.json(details.edit))));
  if (details?.extras) parts.push(...under("Extras", page.element("pre", { tabIndex: 0 }, words.json(details.extras[0]))));
  if (details?.cut) parts.push(page.element("p", {}, "There is more of this than the page has room for: see the journal and report.json."));
  parts.push(...under("Cost", page.table(stepCosts(step, report.full_render_seconds))));
  parts.push(...under("Files", page.element("div", {}, page.element("code", {}, step.frame)),
    page.element("div", {}, page.element("code", {}, step.preview))));
  if (details?.resumed) parts.push(...under("Kept", "This frame is from an earlier run of the same inputs."));
  return parts;
}

/** Seconds of a full render of a step's own state, or of the run's where that is not known. */
function fullSeconds(step, full) {
  return step.full_render.seconds ?? full;
}

function stepCosts(step, runSeconds) {
  const rows = [["seconds, total", page.seconds(step.seconds.total)]], full = fullSeconds(step, runSeconds);
  if (step.seconds.cpu !== null) rows.push(["CPU seconds", page.seconds(step.seconds.cpu)]);
  if (full && step.step > 0 && step.seconds.total > 0)
    rows.push(["full render / step", `${Number((full / step.seconds.total).toPrecision(3))} x`]);
  if (step.full_render.seconds !== null)
    rows.push([`full render of this state${step.full_render.measured ? "" : ", estimated"}`, page.seconds(step.full_render.seconds)]);
  if (step.full_render.cpu_seconds !== null) rows.push(["its CPU seconds", page.seconds(step.full_render.cpu_seconds)]);
  for (const stage of ["classify", "select", "test", "update", "evaluate", "write"])
    rows.push([stage, page.seconds(step.seconds[stage])]);
  for (const [key, name] of [["pixels_changed", "pixels changed"], ["samples_affected", "samples affected"],
    ["regions_visited", "regions visited"], ["regions_culled", "regions culled"], ["ray_tests", "ray tests"],
    ["ray_tests_culled", "ray tests culled"], ["ray_updates", "ray updates"], ["shadow_updates", "shadow updates"],
    ["color_trees_evaluated", "colour trees evaluated"]]) rows.push([name, page.count(step[key])]);
  rows.push(["resident", page.bytes(step.resident.total)]);
  if (step.verify.pixels_compared !== null)
    rows.push(["verified, pixels that differ", `${page.count(step.verify.pixels_different)} of ${page.count(step.verify.pixels_compared)}`]);
  return rows;
}

function runParts(report) {
  const rows = [["scene", report.scene.file], ["scene hash", report.scene.hash], ["journal", report.journal.file],
    ["journal hash", report.journal.hash], ["program", `relook ${report.program}`], ["camera", report.camera],
    ["resolution", report.resolution.join(" x ")], ["samples a pixel", report.samples],
    ...page.noise(report).map((text) => ["noise before any step", text.replace("noise ", "")]),
    ["machine", `${report.machine.threads} threads, ${report.machine.cpu}`],
    ["full render", report.full_render_seconds ? page.seconds(report.full_render_seconds) : "not measured"],
    ["all steps", page.seconds(report.seconds)]];
  for (const [name, value] of Object.entries(report.options)) rows.push([`option ${name}`, JSON.stringify(value)]);
  for (const [name, value] of Object.entries(report.cache_bytes)) rows.push([`cache, ${name}`, page.bytes(value)]);
  const parts = [page.table(rows)];
  if (report.journal.extras) parts.push(...under("Extras of the journal", page.element("pre", { tabIndex: 0 }, words.json(report.journal.extras))));
  if (report.cache_damage.length > 0)
    parts.push(...under("Parts of the cache that were traced again", list(report.cache_damage)));
  return parts;
}
