"use strict";
// Data and elements. Whatever comes from data becomes text nodes: nothing is ever parsed as HTML.

const page = {
  /** What the ids of data end with: in a page of several runs (index_page.h) the number of the one that the address
      names, null while it shows their cards; "" in any other page. */
  suffix: (() => {
    const runs = document.getElementById("runs"), number = Number(new URLSearchParams(location.search).get("run"));
    if (runs === null) return "";
    return Number.isInteger(number) && number >= 1 && number <= Number(runs.dataset.runs) ? `-${number}` : null;
  })(),

  data(id) {
    return JSON.parse(document.getElementById(id + page.suffix).textContent);
  },

  byId(id) {
    return document.getElementById(id);
  },

  /** An element with properties ("data-x" and "aria-x": attributes) and children (elements, or texts). */
  element(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
      if (name.includes("-") || name === "role") element.setAttribute(name, value);
      else element[name] = value;
    }
    element.append(...children.map((child) => (child instanceof Node ? child : String(child))));
    return element;
  },

  /** A table of two columns, names and values; numbers to the right. */
  table(rows) {
    const body = page.element("tbody");
    for (const [name, value] of rows) {
      const cell = page.element("td", { className: "number" }, value);
      body.append(page.element("tr", {}, page.element("th", { scope: "row" }, name), cell));
    }
    return page.element("table", {}, body);
  },

  button(text, work, properties = {}) {
    const button = page.element("button", { type: "button", ...properties }, text);
    button.addEventListener("click", work);
    return button;
  },

  count(value) {
    return Number(value).toLocaleString("en-US");
  },

  seconds(value) {
    if (value >= 1) return `${value.toFixed(2)} s`;
    return value >= 0.001 ? `${(value * 1e3).toPrecision(3)} ms` : `${(value * 1e6).toFixed(0)} µs`;
  },

  bytes(value) {
    const units = ["B", "kB", "MB", "GB", "TB"];
    let unit = 0;
    while (value >= 1000 && unit + 1 < units.length) {
      value /= 1000;
      ++unit;
    }
    return `${unit === 0 ? value : value.toPrecision(3)} ${units[unit]}`;
  },

  /** How far pixels of the first frame are off, as a share of its light: a number, where it is known. */
  noise(report) {
    return report.noise === null || report.noise === undefined ? [] : [`noise ${(100 * report.noise).toPrecision(2)} %`];
  },

  /** What the browser keeps under a name, or null: it may keep nothing. */
  kept(name) {
    try {
      return localStorage.getItem(`relook:${name}`);
    } catch {
      return null;
    }
  },

  /** Whether the browser keeps it. */
  keep(name, text) {
    try {
      localStorage.setItem(`relook:${name}`, text);
      return true;
    } catch {
      return false;
    }
  },

  /** "light" or "dark"; as the system has it until one is chosen, which is remembered. */
  scheme() {
    return document.documentElement.dataset.scheme;
  },

  showScheme(scheme) {
    document.documentElement.dataset.scheme = scheme;
    document.dispatchEvent(new Event("scheme"));
  },

  setScheme(scheme) {
    page.keep("scheme", scheme);
    page.showScheme(scheme);
  },

  startScheme() {
    const query = matchMedia("(prefers-color-scheme: dark)"), chosen = page.kept("scheme");
    const show = () => page.showScheme(page.kept("scheme") ?? (query.matches ? "dark" : "light"));
    if (chosen === "light" || chosen === "dark") page.showScheme(chosen);
    else show();
    query.addEventListener("change", show);
  },

  /** The value of a custom property of page.css. */
  color(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  },
};
