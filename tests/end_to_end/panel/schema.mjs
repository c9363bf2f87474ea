// The part of JSON Schema that hmi/schema/api.schema.json uses: enough to tell whether the server keeps to it.
import { readFileSync } from "node:fs";

const { $defs: definitions } = JSON.parse(readFileSync(new URL("../../../hmi/schema/api.schema.json", import.meta.url), "utf8"));
const known = new Set(["type", "description", "additionalProperties", "properties", "required", "items", "minItems", "maxItems", "enum", "anyOf", "$ref", "minimum", "maximum"]);

const isOf = (type, value) => {
  if (type === "null") return value === null;
  if (type === "array") return Array.isArray(value);
  if (type === "integer") return Number.isInteger(value);
  if (type === "object") return typeof value === "object" && value !== null && !Array.isArray(value);
  return typeof value === type;
};

function* checkObject(schema, value, path) {
  for (const name of schema.required ?? []) if (!(name in value)) yield `${path}.${name} is missing`;
  for (const [name, part] of Object.entries(value)) {
    const own = schema.properties?.[name];
    if (own) yield* check(own, part, `${path}.${name}`);
    else if (schema.additionalProperties === false) yield `${path}.${name} is not in the schema`;
    else if (typeof schema.additionalProperties === "object") yield* check(schema.additionalProperties, part, `${path}.${name}`);
  }
}

function* check(schema, value, path) {
  for (const word of Object.keys(schema)) if (!known.has(word)) throw new Error(`schema.mjs does not know "${word}"`);
  if (schema.$ref) return yield* check(definitions[schema.$ref.split("/").pop()], value, path);
  if (schema.anyOf) {
    if (!schema.anyOf.some((one) => [...check(one, value, path)].length === 0)) yield `${path} fits none of its forms: ${JSON.stringify(value).slice(0, 80)}`;
    return;
  }
  const types = [schema.type ?? []].flat();
  if (types.length > 0 && !types.some((type) => isOf(type, value))) return yield `${path} is no ${types.join(" or ")}: ${JSON.stringify(value)?.slice(0, 80)}`;
  if (schema.enum && !schema.enum.includes(value)) yield `${path} is ${JSON.stringify(value)}, not one of ${schema.enum.join(", ")}`;
  if (schema.minimum !== undefined && value < schema.minimum) yield `${path} is below ${schema.minimum}`;
  if (schema.maximum !== undefined && value > schema.maximum) yield `${path} is above ${schema.maximum}`;
  if (isOf("object", value)) yield* checkObject(schema, value, path);
  if (!Array.isArray(value)) return;
  if (value.length < (schema.minItems ?? 0) || value.length > (schema.maxItems ?? Infinity)) yield `${path} has ${value.length} items`;
  if (schema.items) for (const [i, item] of value.entries()) yield* check(schema.items, item, `${path}[${i}]`);
}

/** What of `value` does not keep to a type of the schema ("Site", or "Order[]" for a list). */
export function misfits(type, value) {
  const name = type.replace("[]", "");
  if (!definitions[name]) throw new Error(`no type ${name}`);
  const one = { $ref: `#/$defs/${name}` };
  return [...check(type.endsWith("[]") ? { type: "array", items: one } : one, value, name)];
}
