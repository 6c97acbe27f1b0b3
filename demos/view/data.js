// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The page's data: JSON, whose long arrays are base64 of little-endian numbers.
'use strict';

/** A typed array of {"u16": "..."}, {"u32": "..."} or {"f32": "..."}. */
function unpacked(json) {
  const [type] = Object.keys(json);
  const text = atob(json[type]);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new {u16: Uint16Array, u32: Uint32Array, f32: Float32Array}[type](bytes.buffer);
}

/** The data as the page has it, with its arrays unpacked. */
function readData() {
  const isPacked = value => value && ['u16', 'u32', 'f32'].some(type => typeof value[type] === 'string');
  const element = document.getElementById('data');
  const data = JSON.parse(element.textContent, (key, value) => isPacked(value) ? unpacked(value) : value);
  element.remove();  // megabytes of text
  return data;
}
