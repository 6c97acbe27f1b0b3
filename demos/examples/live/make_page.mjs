// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Joins the page from its parts:
//   node make_page.mjs OUTPUT MODULE SERPENT THREE ORBIT_CONTROLS PACKAGE
// MODULE: the ES module of plugin/js; SERPENT: the output of serpent.cpp; PACKAGE: the folder with its licences, which
// the page shows.
import {readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';

const HERE = dirname(fileURLToPath(import.meta.url)), VIEW = join(HERE, '../../view'), RECIPES = join(HERE, '../recipes');
const text = (folder, name) => readFileSync(join(folder, name), 'utf8');

/** What the worker has beside the module, and what the page has, in their order. */
const WORKER = [[VIEW, 'shading.js'], [HERE, 'shapes.js'], [HERE, 'scenes.js'], [HERE, 'simulation.js'],
  [HERE, 'worker.js']];
const PAGE = [[VIEW, 'shading.js'], [VIEW, 'stage.js'], [RECIPES, 'bones_three.js'], [HERE, 'shapes.js'],
  [HERE, 'scenes.js'], [HERE, 'actors.js'], [HERE, 'port.js'], [HERE, 'hands.js'], [HERE, 'live.js'],
  [HERE, 'hook.js']];

/** Escapes what would look like the end of a script element, or the start of another one in it. */
const escaped = script => script.replaceAll('</', '<\\/').replaceAll('<!--', '<\\!--');
const joined = files => files.map(([folder, name]) => text(folder, name)).join('');
const asText = html => html.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

/** An ES module as a plain script, whose exports are names like others: a page from a file may make no worker of a
    module. */
function plainScript(module) {
  const script = module.replace(/^export\s+default\s+\w+;?$/gm, '').replace(/^export\s*\{[^}]*\};?/gm, '')
    .replace(/^export\s+(?=async|function|const|let|var|class)/gm, '')
    .replaceAll('import.meta.url', 'self.location.href');
  const isModule = /^\s*(import|export)\b(?!\s*\()/m.test(script);
  if (isModule) throw new Error('the module has imports, or exports of another form');
  return script;
}

/** Positions as words of 16 bits in their box, by axis, each as the difference from the one before, all low bytes
    before all high ones; then the corners of triangles as differences, signed and of 7 bits a byte. They compress
    better so. `unpackSerpent` in worker.js reads it. */
function pack(json) {
  const {positions, triangles: corners, groups, materials} = JSON.parse(json);
  const vertices = positions.length / 3, triangles = corners.length / 3;
  const box = {min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity]};
  positions.forEach((x, i) => {
    box.min[i % 3] = Math.min(box.min[i % 3], x);
    box.max[i % 3] = Math.max(box.max[i % 3], x);
  });
  const plane = 3 * vertices, bytes = [];
  for (let axis = 0; axis < 3; ++axis) {
    for (let v = 0, before = 0; v < vertices; ++v) {
      const low = box.min[axis], word = Math.round(65535 * (positions[3 * v + axis] - low) / (box.max[axis] - low));
      const difference = word - before & 65535;
      bytes[axis * vertices + v] = difference & 255;
      bytes[plane + axis * vertices + v] = difference >> 8;
      before = word;
    }
  }
  let before = 0;
  for (const corner of corners) {
    const difference = corner - before;
    let number = difference < 0 ? -2 * difference - 1 : 2 * difference;
    for (; number > 127; number >>= 7) bytes.push(number & 127 | 128);
    bytes.push(number);
    before = corner;
  }
  const zipped = gzipSync(Uint8Array.from(bytes), {level: 9}).toString('base64');
  return {serpent: {vertices, triangles, groups, box}, materials, zipped, native: JSON.parse(text(HERE, 'native_hashes.json'))};
}

/** The template, with each word of the form @NAME@ replaced once by its text. */
function filled(template, words) {
  let result = '', rest = template;
  for (const [word, instead] of Object.entries(words)) {
    const at = rest.indexOf(word);
    if (at < 0) throw new Error(`live.html does not contain ${word}`);
    result += rest.slice(0, at) + instead;
    rest = rest.slice(at + word.length);
  }
  return result + rest;
}

/** tetskin's licence, and those of all that its module has inside, each under its name. */
function licencesIn(folder) {
  const names = readdirSync(join(folder, 'licences')).sort();
  const others = names.map(name => `${name.replace(/\.txt$/, '')}\n\n${text(join(folder, 'licences'), name)}`);
  return [text(folder, 'LICENSE'), ...others];
}

const [output, module, serpent, three, orbitControls, folder] = process.argv.slice(2);
if (!folder) {
  console.error('usage: node make_page.mjs OUTPUT MODULE SERPENT THREE ORBIT_CONTROLS PACKAGE');
  process.exit(2);
}
const notice = text(VIEW, 'three_notice.txt');
const {homepage} = JSON.parse(text(folder, 'package.json'));
const page = filled(text(HERE, 'live.html'), {
  '@STYLE@': text(VIEW, 'view.css') + text(HERE, 'live.css'),
  '@SOURCE@': homepage ? `<a href="${asText(homepage)}" target="_blank" rel="noopener">Source</a>` : '',
  '@LICENCES@': asText([...licencesIn(folder), notice].join('\n\n')),
  '@NOTICE@': notice,
  '@MODULE@': escaped(plainScript(readFileSync(module, 'utf8'))),
  '@WORKER@': escaped(joined(WORKER)),
  '@MODEL@': JSON.stringify(pack(readFileSync(serpent, 'utf8'))).replaceAll('<', '\\u003c'),
  '@THREE@': escaped(readFileSync(three, 'utf8')),
  '@CONTROLS@': escaped(readFileSync(orbitControls, 'utf8')),
  '@SCRIPTS@': escaped(joined(PAGE)),
});
writeFileSync(output, page);
const megabytes = bytes => (bytes / 1e6).toFixed(2);
console.log(`${output}: ${megabytes(page.length)} MB, ${megabytes(gzipSync(page, {level: 9}).length)} compressed`);
