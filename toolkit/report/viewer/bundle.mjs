// Bundles viewer.js with all that it uses, and writes it as a C++ source.
// usage: node bundle.mjs FOLDER_OF_NODE_MODULES SOURCE.cpp
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const [modules, output] = process.argv.slice(2);
const { build } = createRequire(join(modules, 'package.json'))('esbuild');

const result = await build({
  entryPoints: [join(dirname(fileURLToPath(import.meta.url)), 'viewer.js')],
  bundle: true,
  minify: true,
  write: false,
  metafile: true,
  format: 'iife',
  target: 'es2022',
  charset: 'ascii',
  legalComments: 'none',
  nodePaths: [join(modules, 'node_modules')],
  logLevel: 'warning',
});

// Whoever passes on a report passes on these packages, too.
function licenses(inputs) {
  const folders = new Set();
  for (const input of inputs) {
    const match = input.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//);
    if (match) folders.add(match[1]);
  }
  return [...folders].sort().map((folder) => {
    const { name, version, license } = JSON.parse(readFileSync(join(folder, 'package.json')));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? readFileSync(join(folder, file), 'utf8').trim() : license;
    return `${name} ${version}\n\n${text}`;
  });
}

// A report asks for nothing from elsewhere; the addresses in these packages only document something.
function withoutAddresses(text) {
  return text.replace(/https?:\/\/[^\s"'`<>)\\]*/g, '');
}

const notice = licenses(Object.keys(result.metafile.inputs)).join('\n\n')
  .replaceAll('*/', '* /');
const script = withoutAddresses(`/*!\n${notice}\n*/\n${result.outputFiles[0].text}`);
if (/<\/script|<!--/i.test(script)) throw new Error('the bundle would end its script element');

// Compilers take literals of limited length; they join neighbours.
const delimiter = 'viewer';
if (script.includes(`)${delimiter}"`)) throw new Error('the bundle holds the literal\'s delimiter');
const pieces = Buffer.from(script, 'utf8').toString('latin1').match(/[^]{1,15000}/g);
const literals = pieces.map((piece) => `R"${delimiter}(${piece})${delimiter}"`).join('\n');
writeFileSync(output, Buffer.from(`#include "toolkit/report/viewer_data.h"

namespace mimetra {

std::string_view viewer_script() {
  static constexpr char kScript[] =
${literals};
  return {kScript, sizeof kScript - 1};
}

}  // namespace mimetra
`, 'latin1'));
