// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Workers of the page: made from text in the page, so that it also opens from a file.

class Port {
  /** onTrouble: called with a sentence if the worker itself fails, after which it answers nothing. */
  constructor(text, onTrouble) {
    const url = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
    this.waiting = new Map();
    this.count = 0;
    this.worker = new Worker(url);
    this.worker.onmessage = ({data}) => this.take(data);
    this.worker.onerror = event => {
      event.preventDefault();
      this.fail(new Error(event.message || 'The worker did not start.'));
      onTrouble(event.message || 'The worker did not start.');
    };
  }

  /** A promise of the answer to a message. progress: called with what the worker tells before */
  ask(type, data = {}, {transfer = [], progress = () => {}} = {}) {
    return new Promise((resolve, reject) => {
      const id = ++this.count;
      this.waiting.set(id, {resolve, reject, progress});
      this.worker.postMessage({id, type, data}, transfer);
    });
  }

  take({id, answer, error, progress}) {
    const waiting = this.waiting.get(id);
    if (!waiting) return;
    if (progress) return waiting.progress(progress);
    this.waiting.delete(id);
    if (error) return waiting.reject(Object.assign(new Error(error.message), {code: error.code, at: error.stack}));
    waiting.resolve(answer);
  }

  fail(error) {
    for (const {reject} of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  end() {
    this.worker.terminate();
    this.fail(Object.assign(new Error('Cancelled'), {code: 'Cancelled'}));
  }
}
