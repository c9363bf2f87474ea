// A .gz beside every text file of dist/, which the server sends to browsers that take it.
import { readdir, readFile, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";

const dist = new URL("../dist/", import.meta.url);
let plain = 0;
let zipped = 0;
for (const entry of await readdir(dist, { recursive: true })) {
  if (!/\.(html|js|css|svg|json|webmanifest)$/.test(entry)) continue;
  const content = await readFile(new URL(entry, dist));
  const gzip = gzipSync(content, { level: 9 });
  await writeFile(new URL(`${entry}.gz`, dist), gzip);
  plain += content.length;
  zipped += gzip.length;
}
console.log(`page weight ${(plain / 1024).toFixed(0)} kB, compressed ${(zipped / 1024).toFixed(0)} kB`);
