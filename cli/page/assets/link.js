"use strict";
// What is shown, in the address: "#step=3_01&view=review&a=2&mode=wipe&zoom=2,120,80". A link that names `view` says
// everything, and what it leaves out is as it was at first; "#step=3_01" alone leaves all else as it is.

const link = {
  parts: ["sheet", "step", "plots", "run"],
  timer: 0,

  /** {part, label, values: URLSearchParams, isWhole}. */
  read() {
    const values = new URLSearchParams(location.hash.slice(1));
    const part = link.parts.find((name) => values.has(name)) ?? "sheet";
    return { part, label: values.get(part) || null, values, isWhole: values.has("view") };
  },

  text(part, label, values) {
    const rest = new URLSearchParams(Object.entries(values).filter(([, value]) => value !== null && value !== ""));
    return `#${part}${label ? `=${encodeURIComponent(label)}` : ""}&${rest}`.replaceAll("%2C", ",");
  },

  /** Goes to another part or frame, as a place that Back returns from. */
  push(text) {
    clearTimeout(link.timer);
    if (text !== location.hash) history.pushState(null, "", text);
  },

  /** The same place with other settings; soon, since browsers refuse many changes in a second. */
  replace(text) {
    clearTimeout(link.timer);
    link.timer = setTimeout(() => {
      if (text() !== location.hash) history.replaceState(null, "", text());
    }, 120);
  },
};
