// The build of the page: flat files with hashed names in ../static, which the wheel and the sdist contain.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";

import { defineConfig, type Plugin, type Rollup } from "vite";

// The service worker keeps every file of the build; it changes, and is therefore fetched again, when one of them does.
function listFiles(): Plugin {
  return {
    name: "list-files",
    generateBundle(_, bundle) {
      const worker = bundle["sw.js"];
      if (worker?.type !== "chunk") throw new Error("the service worker is missing from the build");
      this.emitFile({ type: "asset", fileName: "third-party.txt", source: notices(bundle) });
      const content = new Map(readdirSync("public").map((name) => [name, readFileSync(`public/${name}`)] as const));
      for (const [name, file] of Object.entries(bundle)) {
        if (name !== "sw.js") content.set(name, Buffer.from(file.type === "chunk" ? file.code : file.source));
      }
      const files = [...content.keys()].filter((name) => name !== "index.html").sort();
      const digest = createHash("sha256");
      for (const name of [...content.keys()].sort()) digest.update(content.get(name)!);
      worker.code = worker.code.replace("__FILES__", JSON.stringify(files)).replace("__VERSION__", JSON.stringify(digest.digest("hex").slice(0, 16)));
    },
  };
}

// The licences of all packages of which code is in the bundle.
function notices(bundle: Rollup.OutputBundle): string {
  const modules = Object.values(bundle).flatMap((file) => (file.type === "chunk" ? Object.keys(file.modules) : []));
  const names = new Set(modules.flatMap((id) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(id)?.[1] ?? []));
  const texts = [...names].sort().map((name) => {
    const folder = `node_modules/${name}`;
    const { version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = readdirSync(folder).find((one) => /^licen[cs]e/i.test(one));
    if (!file) throw new Error(`${name} has no licence`);
    return `${name} ${version} (${license})\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
  });
  return `The page of Fieldhand contains code of these packages.\n\n${texts.join("\n----\n\n")}`;
}

export default defineConfig({
  base: "/static/",
  publicDir: "public",
  build: {
    outDir: "../static",
    emptyOutDir: true,
    assetsDir: "",
    assetsInlineLimit: 0, // the security policy allows no data: addresses
    modulePreload: { polyfill: false },
    target: "es2022",
    rollupOptions: {
      input: { index: "index.html", sw: "src/sw.ts" },
      output: { entryFileNames: (chunk) => (chunk.name === "sw" ? "sw.js" : "[name]-[hash].js") },
    },
  },
  plugins: [listFiles()],
});
