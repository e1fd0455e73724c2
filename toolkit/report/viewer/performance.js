// Unpacks the performance in a report. viewer_data.cpp writes the layout.
import { unzlibSync } from 'fflate';

function unpackBytes(text) {
  return unzlibSync(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
}

// Rows of `width` 16-bit numbers. The low bytes of a row come before its high bytes.
function unpackRows(text, width) {
  const bytes = unpackBytes(text);
  const numbers = new Int16Array(bytes.length / 2);
  for (let start = 0; start < numbers.length; start += width) {
    for (let i = 0; i < width; ++i) {
      numbers[start + i] = bytes[2 * start + i] | (bytes[2 * start + width + i] << 8);
    }
  }
  return numbers;
}

// Rows as in unpackRows(), each stored as the difference from the row before.
function unpackDifferences(text, width) {
  const numbers = unpackRows(text, width);
  for (let i = width; i < numbers.length; ++i) numbers[i] += numbers[i - width];
  return numbers;
}

function unpackIndices(text) {
  const bytes = unpackBytes(text);
  const indices = new Int32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  for (let i = 1; i < indices.length; ++i) indices[i] += indices[i - 1];
  return indices;
}

// Frames stored as whole poses; the first one is the rest pose.
class WholePoses {
  constructor(packed, width) {
    this.width = width;
    this.step = packed.step;
    this.poses = unpackDifferences(packed.poses, width);
    this.rest = Float32Array.from(this.poses.subarray(0, width), (steps) => this.step * steps);
  }

  // Writes the positions between frame `first` and the next one to the beginning of `out`.
  mix(first, share, out) {
    const from = (first + 1) * this.width;
    const to = share > 0 ? from + this.width : from;
    for (let i = 0; i < this.width; ++i) {
      out[i] = this.step * (this.poses[from + i] * (1 - share) + this.poses[to + i] * share);
    }
  }
}

// Frames stored as mixtures of a few poses, with corrections of some coordinates.
class MixedPoses {
  constructor(packed, width) {
    this.width = width;
    this.step = packed.step;
    this.size = packed.basisSize;
    this.basis = unpackRows(packed.basis, width);
    this.basisStep = packed.basisStep * packed.step;
    this.weights = unpackDifferences(packed.weights, this.size);
    this.places = unpackIndices(packed.correctedPlaces);
    this.corrections = unpackIndices(packed.corrections);
    this.rest = Float32Array.from(unpackRows(packed.rest, width),
      (steps) => (this.step * steps) / packed.stepsOfRest);
    // Index of the first correction of each frame.
    this.starts = [0];
    for (let i = 0; i < this.places.length; ++i) {
      while (this.places[i] >= this.starts.length * width) this.starts.push(i);
    }
  }

  mix(first, share, out) {
    out.set(this.rest);
    for (let k = 0; k < this.size; ++k) {
      const here = this.weights[first * this.size + k];
      const next = share > 0 ? this.weights[(first + 1) * this.size + k] : 0;
      const weight = this.basisStep * (here * (1 - share) + next * share);
      if (weight === 0) continue;
      const row = k * this.width;
      for (let i = 0; i < this.width; ++i) out[i] += weight * this.basis[row + i];
    }
    this.correct(first, 1 - share, out);
    if (share > 0) this.correct(first + 1, share, out);
  }

  correct(frame, share, out) {
    const end = this.starts[frame + 1] ?? this.places.length;
    for (let i = this.starts[frame] ?? end; i < end; ++i) {
      out[this.places[i] - frame * this.width] += share * this.step * this.corrections[i];
    }
  }
}

export function unpackPerformance(packed) {
  const surfaces = packed.surfaces.map((surface) => ({
    vertices: surface.vertices,
    triangles: unpackIndices(surface.triangles),
    places: unpackIndices(surface.places),
    regions: unpackIndices(surface.regions),
  }));
  return {
    ...packed,
    surfaces,
    meshes: packed.meshes.map((mesh) => {
      const surface = surfaces[mesh.surface];
      const Poses = mesh.basis === undefined ? WholePoses : MixedPoses;
      return { ...mesh, surface, poses: new Poses(mesh, 3 * surface.vertices) };
    }),
  };
}
