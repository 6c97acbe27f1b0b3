// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How a surface follows the nodes of its cage, as the library has it: see quadratic_skinning.h and tet_maps.h there.
//
// With b the weights of a tet's first three nodes and e_ij the vector of its edge (i, j):
//   linear     x(b) = x3 + sum_k b_k (x_k - x3)
//   quadratic  the same + sum_{i<j} b_i b_j e_ij,  e_ij = (F_i - F_j) (X_j - X_i) / 2,  F the gradients at the nodes
// Outside its tet, a vertex takes the quadratic part at the closest point, continued to first order.

class Skin {
  /** cage: the "cage" of a model in the page's data */
  constructor(cage) {
    Object.assign(this, cage.embedding, cage.stencils);
    this.runCount = this.runStarts.length - 1;
    this.firstOutside = this.runStarts[this.insideRuns];
    this.gradients = new Float64Array(9 * (this.starts.length - 1));
    this.edges = new Float64Array(this.halfRest.length);
    this.restLengths = restLengthsOf(this.halfRest);
    // Of one tet: the coefficients of x(b).
    this.last = new Float64Array(3);
    this.slope = new Float64Array(9);    // of b_k
    this.bend = new Float64Array(9);     // of -b_k b_k
    this.product = new Float64Array(9);  // of b_p b_q, by the third one
  }

  /** Writes the positions of all vertices for these nodes, three numbers each. */
  update(nodes, quadratic, out) {
    if (quadratic) {
      this.updateGradients(nodes);
      this.updateEdges();
    }
    for (let run = 0; run < this.runCount; ++run) {
      this.setLinear(nodes, run);
      if (quadratic) this.addQuadratic(run);
      const first = this.runStarts[run], end = this.runStarts[run + 1];
      if (quadratic && run >= this.insideRuns) {
        this.writeOutside(first, end, this.shortestEdge(run), out);
      } else {
        this.write(first, end, out);
      }
    }
  }

  /** F = sum of x_node factor^T, column by column. */
  updateGradients(nodes) {
    const {starts, entryNodes, entryFactors, gradients} = this;
    for (let g = 0; g + 1 < starts.length; ++g) {
      gradients.fill(0, 9 * g, 9 * g + 9);
      for (let entry = starts[g]; entry < starts[g + 1]; ++entry) {
        for (let column = 0; column < 3; ++column) {
          const factor = entryFactors[3 * entry + column];
          for (let k = 0; k < 3; ++k) gradients[9 * g + 3 * column + k] += nodes[3 * entryNodes[entry] + k] * factor;
        }
      }
    }
  }

  /** No vector is longer than half its edge at rest. */
  updateEdges() {
    const {gradients, edgeGradients, halfRest, edges} = this;
    for (let edge = 0; edge < this.restLengths.length; ++edge) {
      const a = 9 * edgeGradients[2 * edge], b = 9 * edgeGradients[2 * edge + 1];
      let squared = 0;
      for (let k = 0; k < 3; ++k) {
        let sum = 0;
        for (let c = 0; c < 3; ++c) {
          sum += (gradients[a + 3 * c + k] - gradients[b + 3 * c + k]) * halfRest[3 * edge + c];
        }
        edges[3 * edge + k] = sum;
        squared += sum * sum;
      }
      const limit = 0.5 * this.restLengths[edge];
      if (squared <= limit * limit) continue;
      for (let k = 0; k < 3; ++k) edges[3 * edge + k] *= limit / Math.sqrt(squared);
    }
  }

  setLinear(nodes, run) {
    const at = 4 * run;
    this.bend.fill(0);
    this.product.fill(0);
    for (let k = 0; k < 3; ++k) {
      this.last[k] = nodes[3 * this.runNodes[at + 3] + k];
      for (let n = 0; n < 3; ++n) this.slope[3 * n + k] = nodes[3 * this.runNodes[at + n] + k] - this.last[k];
    }
  }

  addQuadratic(run) {
    // A run's edges are (0,1) (0,2) (0,3) (1,2) (1,3) (2,3).
    const ids = this.runEdges.subarray(6 * run, 6 * run + 6);
    const to3 = [ids[2], ids[4], ids[5]], opposite = [ids[3], ids[1], ids[0]];
    for (let n = 0; n < 3; ++n) {
      for (let k = 0; k < 3; ++k) this.bend[3 * n + k] = this.edges[3 * to3[n] + k];
    }
    for (let n = 0; n < 3; ++n) {
      const p = 3 * ((n + 1) % 3), q = 3 * ((n + 2) % 3);
      for (let k = 0; k < 3; ++k) {
        this.slope[3 * n + k] += this.bend[3 * n + k];
        this.product[3 * n + k] = this.edges[3 * opposite[n] + k] - this.bend[p + k] - this.bend[q + k];
      }
    }
  }

  /** x(b) - x3, coordinate k. */
  valueAt(b0, b1, b2, k) {
    const {slope, bend, product} = this;
    return (slope[k] - bend[k] * b0 + product[6 + k] * b1 + product[3 + k] * b2) * b0 +
      (slope[3 + k] - bend[3 + k] * b1 + product[k] * b2) * b1 + (slope[6 + k] - bend[6 + k] * b2) * b2;
  }

  write(first, end, out) {
    const {weights, slotVertices} = this;
    for (let slot = first; slot < end; ++slot) {
      const b0 = weights[3 * slot], b1 = weights[3 * slot + 1], b2 = weights[3 * slot + 2];
      const to = 3 * slotVertices[slot];
      for (let k = 0; k < 3; ++k) out[to + k] = this.last[k] + this.valueAt(b0, b1, b2, k);
    }
  }

  /** longest: of what the quadratic part may add to a vertex. */
  writeOutside(first, end, longest, out) {
    const {weights, closest, slope, bend} = this;
    const linear = [0, 0, 0], added = [0, 0, 0];
    for (let slot = first; slot < end; ++slot) {
      const b = weights.subarray(3 * slot, 3 * slot + 3);
      const at = 3 * (slot - this.firstOutside), c = closest.subarray(at, at + 3);
      let squared = 0;
      for (let k = 0; k < 3; ++k) {
        linear[k] = 0;
        added[k] = this.valueAt(c[0], c[1], c[2], k);
        for (let n = 0; n < 3; ++n) {
          linear[k] += (slope[3 * n + k] - bend[3 * n + k]) * b[n];
          added[k] += this.derivativeAt(c, n, k) * (b[n] - c[n]);
        }
        added[k] -= linear[k];
        squared += added[k] * added[k];
      }
      const share = squared > longest * longest ? longest / Math.sqrt(squared) : 1;
      const to = 3 * this.slotVertices[slot];
      for (let k = 0; k < 3; ++k) out[to + k] = this.last[k] + linear[k] + share * added[k];
    }
  }

  /** By b_n, coordinate k. */
  derivativeAt(b, n, k) {
    const p = (n + 1) % 3, q = (n + 2) % 3;
    return this.slope[3 * n + k] - 2 * this.bend[3 * n + k] * b[n] + this.product[3 * q + k] * b[p] +
      this.product[3 * p + k] * b[q];
  }

  /** Of a run's tet, at rest. */
  shortestEdge(run) {
    let shortest = Infinity;
    for (let i = 0; i < 6; ++i) shortest = Math.min(shortest, this.restLengths[this.runEdges[6 * run + i]]);
    return shortest;
  }
}

function restLengthsOf(halves) {
  const lengths = new Float64Array(halves.length / 3);
  for (let e = 0; e < lengths.length; ++e) {
    lengths[e] = 2 * Math.hypot(halves[3 * e], halves[3 * e + 1], halves[3 * e + 2]);
  }
  return lengths;
}
