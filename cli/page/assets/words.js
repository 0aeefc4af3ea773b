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

  /** Indented, lists of numbers in one line. */
  json(value) {
    return JSON.stringify(value, null, 1).replace(/\[\s*(-?[\d.e+-]+(?:,\s*-?[\d.e+-]+)*)\s*\]/g,
      (match, list) => `[${list.replace(/,\s*/g, ", ")}]`);
  },

  operation({ op, path, from, value }) {
    const tokens = words.tokens(path), entity = words.entity(tokens), property = words.property(tokens);
    const place = property ? `${entity}: ${property}` : entity;
    switch (op) {
      case "add":
        return property ? `${place} becomes ${words.value(value)}` : `${entity} is added: ${words.value(value)}`;
      case "replace":
        return `${place} becomes ${words.value(value)}`;
      case "remove":
        return `${place} is removed`;
      case "move":
        return `${place} is moved here from ${from}`;
      case "copy":
        return `${place} is copied from ${from}`;
      default:
        return `only if ${place} is ${words.value(value)}`;
    }
  },
};
