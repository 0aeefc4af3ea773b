"use strict";
// Edits in words: "material Paint: base colour becomes 0.1, 0.9, 0.1, 1".

const words = {
  entities: {
    materials: "material", textures: "texture", images: "image", samplers: "sampler", meshes: "mesh",
    lights: "light", nodes: "node", scene: "scene",
  },
  containers: new Set(["pbrMetallicRoughness", "extensions", "extras", "relook"]),
  axes: { translation: "xyz", scale: "xyz", rotation: "xyzw" },

  tokens(pointer) {
    return pointer.split("/").slice(1).map((token) => token.replaceAll("~1", "/").replaceAll("~0", "~"));
  },

  /** "baseColorFactor" -> "base colour". */
  plain(token) {
    const text = token.replace(/Factor$/, "").replace(/([a-z0-9])([A-Z])/g, "$1 $2").toLowerCase();
    return text.replaceAll("color", "colour");
  },

  entity(tokens) {
    const kind = words.entities[tokens[0]] ?? tokens[0] ?? "document";
    return tokens[0] === "scene" || tokens.length < 2 ? kind : `${kind} ${tokens[1]}`;
  },

  property(tokens) {
    const rest = tokens.slice(tokens[0] === "scene" ? 1 : 2)
      .filter((token) => !words.containers.has(token) && !/^KHR_|^EXT_/.test(token));
    if (rest.length === 0) return "";
    const last = rest[rest.length - 1], owner = rest[rest.length - 2];
    if (rest.length > 1 && /^\d+$/.test(last)) {
      const axes = words.axes[owner] ?? (/color/i.test(owner) ? "rgba" : "");
      const component = axes[Number(last)] ?? `component ${last}`;
      return `${rest.slice(0, -1).map(words.plain).join(", ")} ${component}`;
    }
    return rest.map(words.plain).join(", ");
  },

  value(value) {
    if (Array.isArray(value) && value.every((part) => typeof part === "number")) return value.join(", ");
    return typeof value === "string" ? `"${value}"` : JSON.stringify(value);
  },

  /** A value for a small place: numbers to four digits, files without folders. */
  short(value) {
    const one = (part) => (typeof part === "number" ? String(Number(part.toPrecision(4))) : part);
    if (typeof value === "number") return one(value);
    if (typeof value === "string") return value.split("/").pop();
    if (Array.isArray(value) && value.every((part) => typeof part === "number")) return value.map(one).join(", ");
    const text = JSON.stringify(value) ?? "";
    return text.length > 48 ? `${text.slice(0, 47)}…` : text;
  },

  /** What an axis of a wedge is called: by its label, else by its path. */
  axis({ path, label }) {
    if (label) return label;
    const tokens = words.tokens(path);
    return [tokens[0] === "scene" ? "" : tokens[1] ?? "", words.property(tokens).replaceAll(",", "")].filter((text) => text).join(" ") || path;
  },

  /** An operation for a small place: "Key intensity 4". */
  brief(operation) {
    if (operation.op !== "replace") return words.operation(operation, words.short);
    const { path, value } = operation, isOpaque = /colorfactor$/i.test(path) && Array.isArray(value) && value.length === 4 && value[3] === 1;
    return `${words.axis({ path })} ${words.short(isOpaque ? value.slice(0, 3) : value)}`;
  },

  /** Indented, lists of numbers in one line. */
  json(value) {
    return JSON.stringify(value, null, 1).replace(/\[\s*(-?[\d.e+-]+(?:,\s*-?[\d.e+-]+)*)\s*\]/g,
      (match, list) => `[${list.replace(/,\s*/g, ", ")}]`);
  },

  /** `show` makes the text of a value. */
  operation({ op, path, from, value }, show = words.value) {
    const tokens = words.tokens(path), entity = words.entity(tokens), property = words.property(tokens);
    const place = property ? `${entity}: ${property}` : entity;
    switch (op) {
      case "add":
        return property ? `${place} becomes ${show(value)}` : `${entity} is added: ${show(value)}`;
      case "replace":
        return `${place} becomes ${show(value)}`;
      case "remove":
        return `${place} is removed`;
      case "move":
        return `${place} is moved here from ${from}`;
      case "copy":
        return `${place} is copied from ${from}`;
      default:
        return `only if ${place} is ${show(value)}`;
    }
  },
};
