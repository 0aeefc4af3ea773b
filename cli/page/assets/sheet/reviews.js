"use strict";
// What people think of frames: stars, approved or rejected, a note. The browser keeps them, by scene and journal; they go
// to others as a file.

class Reviews {
  constructor(data) {
    const { report } = data;
    this.data = data;
    this.key = `reviews:${report.scene.hash}:${report.journal.hash}`;
    this.latest = `reviews:${report.scene.hash}:${String(report.journal.file).split("/").pop()}`;  // the key of the journal as it was last
    this.marks = new Map();  // by label: {stars, verdict, note}
    this.listeners = [];
    this.isKept = true;
    try {
      const kept = page.kept(this.key), before = page.kept(page.kept(this.latest) ?? "");
      if (kept) this.take(JSON.parse(kept));
      else if (before) this.take(JSON.parse(before), Reviews.isSameStep);  // the journal has grown
    } catch {
      this.marks.clear();  // not ours
    }
  }

  of(entry) {
    return this.marks.get(this.data.labels[entry]) ?? Reviews.none;
  }

  isEmpty(marks) {
    return marks.stars === 0 && marks.verdict === "" && marks.note === "";
  }

  set(entry, change) {
    const marks = { ...this.of(entry), ...change }, label = this.data.labels[entry];
    if (this.isEmpty(marks)) this.marks.delete(label);
    else this.marks.set(label, marks);
    this.save();
    for (const listener of this.listeners) listener(entry);
  }

  /** A verdict again takes it back. */
  toggle(entry, verdict) {
    this.set(entry, { verdict: this.of(entry).verdict === verdict ? "" : verdict });
  }

  save() {
    this.isKept = page.keep(this.key, JSON.stringify(this.list())) && page.keep(this.latest, this.key);
  }

  list() {
    return this.data.steps.map((step, entry) => ({ label: step.label, name: step.name, ...this.of(entry) }))
      .filter((marks) => !this.isEmpty(marks));
  }

  /** Takes marks from a list; the number of those taken. */
  take(list, isSame = () => true) {
    const byLabel = new Map(this.data.steps.map((step) => [step.label, step]));
    let count = 0;
    for (const item of Array.isArray(list) ? list : []) {
      const step = byLabel.get(item?.label), stars = Math.round(Number(item?.stars));
      if (!step || !isSame(step, item)) continue;
      const marks = {
        stars: stars >= 0 && stars <= 5 ? stars : 0,
        verdict: ["approved", "rejected"].includes(item.verdict) ? item.verdict : "",
        note: typeof item.note === "string" ? item.note.slice(0, Reviews.longestNote) : "",
      };
      if (this.isEmpty(marks)) continue;
      this.marks.set(step.label, marks);
      ++count;
    }
    return count;
  }

  exported() {
    const { scene, journal } = this.data.report, name = ({ file, hash }) => ({ file: String(file).split("/").pop(), hash });
    return `${JSON.stringify({ relook: "reviews/1", scene: name(scene), journal: name(journal), steps: this.list() }, null, 1)}\n`;
  }

  /** Takes what a file says; one sentence about it. Of another journal those whose number and name are the same. */
  imported(text) {
    let file = null;
    try {
      file = JSON.parse(text);
    } catch {
      return "That file is no JSON.";
    }
    if (file?.relook !== "reviews/1" || !Array.isArray(file.steps)) return "That file has no notes of a relook report.";
    const isOther = file.journal?.hash !== this.data.report.journal.hash;
    const count = this.take(file.steps, isOther ? Reviews.isSameStep : undefined);
    this.save();
    for (const listener of this.listeners) listener(null);
    const left = file.steps.length - count;
    return `${count} ${count === 1 ? "frame has" : "frames have"} their notes from the file${left > 0 ? `; ${left} of it are of no frame here` : ""}.`;
  }

  download() {
    const name = String(this.data.report.journal.file).split("/").pop().replace(/\.json$/, "");
    const url = URL.createObjectURL(new Blob([this.exported()], { type: "application/json" }));
    const anchor = page.element("a", { href: url, download: `${name}-notes.json` });
    anchor.click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }
}
Reviews.none = Object.freeze({ stars: 0, verdict: "", note: "" });
Reviews.longestNote = 4000;
Reviews.isSameStep = (step, marks) => step.name === marks.name;  // of the same number, in another journal

/** "★★★ ✓" and the note, as text; null without any. */
function reviewText(marks) {
  const parts = [];
  if (marks.stars > 0) parts.push("★".repeat(marks.stars));
  if (marks.verdict) parts.push(marks.verdict === "approved" ? "✓ approved" : "✕ rejected");
  return parts.join("  ") || null;
}

/** The controls of one frame's marks. `isSmall`: without the note. */
function reviewControls(reviews, entry, isSmall = false) {
  const stars = page.element("div", { role: "group", "aria-label": "Stars", className: "stars" });
  const verdicts = page.element("div", { role: "group", "aria-label": "Verdict", className: "verdicts joined" });
  const parts = [stars, verdicts];
  for (let count = 1; count <= 5; ++count)
    stars.append(page.button("★", () => reviews.set(entry, { stars: reviews.of(entry).stars === count ? 0 : count }),
      { "aria-label": `${count} of 5 stars`, "data-stars": count }));
  verdicts.append(page.button(isSmall ? "✓" : "✓ Approve", () => reviews.toggle(entry, "approved"), { "data-verdict": "approved", "aria-label": "Approve", title: "Approve (y)" }),
    page.button(isSmall ? "✕" : "✕ Reject", () => reviews.toggle(entry, "rejected"), { "data-verdict": "rejected", "aria-label": "Reject", title: "Reject (n)" }));
  if (!isSmall) {
    const note = page.element("textarea", { id: "review-note", rows: 3, maxLength: Reviews.longestNote, value: reviews.of(entry).note,
      placeholder: "A note on this frame" });
    note.addEventListener("input", () => reviews.set(entry, { note: note.value }));
    parts.push(page.element("label", { className: "note" }, "Note ", note));
  }
  const element = page.element("div", { className: "review" }, ...parts);
  element.show = () => {
    const marks = reviews.of(entry);
    for (const button of stars.children) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.stars) <= marks.stars));
      button.classList.toggle("on", Number(button.dataset.stars) <= marks.stars);
    }
    for (const button of verdicts.children) button.setAttribute("aria-pressed", String(button.dataset.verdict === marks.verdict));
  };
  element.show();
  return element;
}
