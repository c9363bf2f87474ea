// hmi/schema/api.schema.json -> src/api_types.ts, so that no wire type is typed twice.
import { readFile, writeFile } from "node:fs/promises";
import { compile } from "json-schema-to-typescript";

const here = new URL(".", import.meta.url);
const schema = JSON.parse(await readFile(new URL("../../schema/api.schema.json", here), "utf8"));
const root = {
  ...schema,
  type: "object",
  additionalProperties: false,
  properties: Object.fromEntries(Object.keys(schema.$defs).map((name) => [name, { $ref: `#/$defs/${name}` }])),
};
const text = await compile(root, "ApiTypes", {
  bannerComment: "// Generated from hmi/schema/api.schema.json by scripts/generate_types.mjs: do not edit.",
  additionalProperties: false,
});
await writeFile(new URL("../src/api_types.ts", here), text);
