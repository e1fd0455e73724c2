// What a report holds of a performance, unpacked: the layout is written by viewer_data.cpp.
import { unzlibSync } from 'fflate';

function unpackBytes(text) {
  return unzlibSync(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
}

// Numbers of 16 bits, each the difference from the one `stride` before it; low bytes of a row of
// `stride` numbers come before its high bytes.
function unpackDifferences(text, stride) {
  const bytes = unpackBytes(text);
  const numbers = new Int16Array(bytes.length / 2);
  for (let start = 0; start < numbers.length; start += stride) {
    for (let i = 0; i < stride; ++i) {
      const low = bytes[2 * start + i];
      const high = bytes[2 * start + stride + i];
      const before = start > 0 ? numbers[start - stride + i] : 0;
      numbers[start + i] = before + (low | (high << 8));
    }
  }
  return numbers;
}

function unpackIndices(text) {
  const bytes = unpackBytes(text);
  const indices = new Int32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  for (let i = 1; i < indices.length; ++i) indices[i] += indices[i - 1];
  return indices;
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
    // The first pose is the one at rest.
    meshes: packed.meshes.map((mesh) => ({
      ...mesh,
      surface: surfaces[mesh.surface],
      poses: unpackDifferences(mesh.poses, 3 * surfaces[mesh.surface].vertices),
    })),
  };
}
