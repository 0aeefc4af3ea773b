"use strict";
// What stands beside a step's frame: its class and why, the edit in words, what it cost. And the part about the run.

/** A heading and what is below it, for a list of elements. */
function under(heading, ...content) {
  return [page.element("h3", {}, heading), ...content];
}

function list(texts) {
  return page.element("ul", {}, ...texts.map((text) => page.element("li", {}, text)));
}

/** `details`: of StepDetails; null while they are not there yet. */
function stepParts(step, details, fullSeconds) {
  const parts = [page.element("p", {}, page.element("span", { className: `chip ${step.class}` }, step.class))];
  if (details?.reasons) parts.push(...under("Why this class", list(details.reasons)));
  if (details?.select) parts.push(...under("Selection", list(details.select)));
  if (details?.edit) {
    parts.push(...under("The edit in words", list(details.edit.map(words.operation))));
    parts.push(...under("The edit", page.element("pre", {}, words.json(details.edit))));
  }
  if (details?.cut) parts.push(page.element("p", {}, "There is more of this than the page has room for: see the journal and report.json."));
  parts.push(...under("Cost", page.table(stepCosts(step, fullSeconds))));
  parts.push(...under("Files", page.element("div", {}, page.element("code", {}, step.frame)),
    page.element("div", {}, page.element("code", {}, step.preview))));
  if (details?.resumed) parts.push(...under("Kept", "This frame is from an earlier run of the same inputs."));
  return parts;
}

function stepCosts(step, full) {
  const rows = [["seconds, total", page.seconds(step.seconds.total)]];
  if (full && step.step > 0 && step.seconds.total > 0)
    rows.push(["full render / step", `${Number((full / step.seconds.total).toPrecision(3))} x`]);
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
    ["full render", report.full_render_seconds ? page.seconds(report.full_render_seconds) : "not measured"]];
  for (const [name, value] of Object.entries(report.options)) rows.push([`option ${name}`, JSON.stringify(value)]);
  for (const [name, value] of Object.entries(report.cache_bytes)) rows.push([`cache, ${name}`, page.bytes(value)]);
  const parts = [page.table(rows)];
  if (report.cache_damage.length > 0)
    parts.push(...under("Parts of the cache that were traced again", list(report.cache_damage)));
  return parts;
}
