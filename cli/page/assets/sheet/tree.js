"use strict";
// The options of a run as a tree: cards in a row where one step follows the other, and below a step the options that
// start from it, too.

class Tree {
  constructor(sheet) {
    this.sheet = sheet;
    this.shown = new Set();  // the matching items, and those above them
    for (const match of sheet.matching)
      for (let item = match; item && !this.shown.has(item); item = item.parent) this.shown.add(item);
    this.matching = new Set(sheet.matching);
  }

  elements() {
    const root = this.sheet.data.items[0];
    return root && this.shown.has(root) ? [this.branch(root)] : [];
  }

  /** The steps from one on that follow each other, and the branches beside them. Where all but one of a step's options
      end at once, they stand below it and the row goes on with that one; else each is a branch of its own. */
  branch(first) {
    const { sheet } = this, branch = page.element("li", { className: "branch" });
    let chain = null;
    for (let item = first; item;) {
      const children = item.children.filter((child) => this.shown.has(child));
      const longer = children.filter((child) => child.children.length > 0);
      const next = children.length === 1 ? children[0] : longer.length === 1 ? longer[0] : null;
      const beside = children.filter((child) => child !== next);
      if (!chain || beside.length > 0) {  // what others start from, too, begins a row: their line comes from it
        chain = page.element("ul", { className: item === first ? "chain" : "chain goes-on" });
        branch.append(chain);
      }
      const card = sheet.card(item);
      card.element.classList.toggle("dimmed", !this.matching.has(item));
      chain.append(card.element);
      if (sheet.unfolded.has(item.number)) chain.append(sheet.unfolded.get(item.number).element);
      if (beside.length > 0) {
        branch.append(page.element("ul", { className: "branches", "aria-label": `From ${sheet.data.name(item.entry)}` },
          ...beside.map((child) => this.branch(child))));
        chain = null;
      }
      item = next;
    }
    return branch;
  }
}
