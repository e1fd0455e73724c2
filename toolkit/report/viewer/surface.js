// A mesh of a performance on the screen: its positions, normals and colours at any time.
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkLight from '@kitware/vtk.js/Rendering/Core/Light';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';

// Lights as in the still pictures: a key light from the upper left, a weak one opposite, and one
// from above.
const lights = [
  { position: [-0.6, 0.7, 1.2], intensity: 0.62 },
  { position: [1.3, 0.2, 0.8], intensity: 0.38 },
  { position: [0, 1.5, 0.3], intensity: 0.2 },
];

// Cells to draw. A triangle with corners in several regions is split into the parts nearest to each
// corner, so that colours do not run into each other. Edges within a region stay whole, as in the
// triangle beyond them, or the background would shine through. `between` lists the vertices whose
// middle is each added point, `cells` is VTK's list, and `triangles` and `regions` have one entry a
// cell.
function cellsOf({ vertices, triangles, regions }) {
  const between = [], cells = [], ofTriangle = [], ofRegion = [];
  const add = (corners) => vertices + between.push(corners) - 1;
  const addCell = (corners, triangle, region) => {
    cells.push(corners.length, ...corners);
    ofTriangle.push(triangle);
    ofRegion.push(region);
  };
  for (let t = 0; t < triangles.length / 3; ++t) {
    const corners = [...triangles.subarray(3 * t, 3 * t + 3)];
    const [a, b, c] = corners.map((v) => regions[v]);
    if (a === b && b === c) {
      addCell(corners, t, a);
      continue;
    }
    const middle = add(corners);
    corners.forEach((v, i) => {
      const next = corners[(i + 1) % 3];
      if (regions[v] === regions[next]) {
        addCell([v, next, middle], t, regions[v]);
        return;
      }
      const edge = add([v, next]);
      addCell([v, edge, middle], t, regions[v]);
      addCell([edge, next, middle], t, regions[next]);
    });
  }
  return {
    between,
    cells: Uint32Array.from(cells),
    triangles: Int32Array.from(ofTriangle),
    regions: Int32Array.from(ofRegion),
  };
}

export class Surface {
  constructor(performance, mesh, camera) {
    this.performance = performance;
    this.mesh = mesh;
    this.drawn = cellsOf(mesh.surface);
    this.regions = this.drawn.regions;
    const coordinates = 3 * (mesh.surface.vertices + this.drawn.between.length);
    this.positions = new Float32Array(coordinates);
    this.normals = new Float32Array(coordinates);
    this.colors = new Uint8Array(coordinates);

    this.data = vtkPolyData.newInstance();
    this.data.getPoints().setData(this.positions, 3);
    this.data.getPolys().setData(this.drawn.cells);
    this.normalArray = vtkDataArray.newInstance({
      name: 'normals', numberOfComponents: 3, values: this.normals,
    });
    this.colorArray = vtkDataArray.newInstance({
      name: 'colors', numberOfComponents: 3, values: this.colors,
    });
    this.data.getPointData().setNormals(this.normalArray);
    this.data.getPointData().setScalars(this.colorArray);
    this.data.getCellData().setScalars(vtkDataArray.newInstance({
      name: 'regions', numberOfComponents: 3, values: this.regionColors(),
    }));

    this.mapper = vtkMapper.newInstance({ scalarVisibility: true });
    this.mapper.setColorModeToDirectScalars();
    this.mapper.setInputData(this.data);
    const actor = vtkActor.newInstance();
    actor.setMapper(this.mapper);
    actor.getProperty().set({ ambient: 0.2, diffuse: 0.84, specular: 0.12, specularPower: 18 });

    this.renderer = vtkRenderer.newInstance({ background: [1, 1, 1] });
    this.renderer.setAutomaticLightCreation(false);
    for (const light of lights) {
      const source = vtkLight.newInstance(light);
      source.setLightTypeToCameraLight();
      this.renderer.addLight(source);
    }
    this.renderer.setActiveCamera(camera);
    this.renderer.addActor(actor);
  }

  // Names the mesh, the region and the nearest vertex at a point of a cell.
  nameOf(cell, point) {
    if (cell < 0) return '';
    const triangle = this.drawn.triangles[cell];
    const corners = this.mesh.surface.triangles.subarray(3 * triangle, 3 * triangle + 3);
    const away = (v) => Math.hypot(...point.map((x, axis) => x - this.positions[3 * v + axis]));
    const nearest = corners.reduce((best, v) => (away(v) < away(best) ? v : best));
    const region = this.regions[cell];
    return `${this.mesh.role}: ${region < 0 ? 'no region' : `region ${region}`}, vertex ${nearest}`;
  }

  // Shows the pose between frame `first` and the next one.
  show(first, share, coloring) {
    const coordinates = 3 * this.mesh.surface.vertices;
    this.mesh.poses.mix(first, share, this.positions);
    this.updateNormals();
    this.updateColors(coloring);
    this.drawn.between.forEach((corners, i) => this.put(corners, coordinates + 3 * i));
    this.data.getPoints().dataChange();
    this.normalArray.modified();
    this.colorArray.modified();
    this.data.modified();
  }

  // Puts an added point into the middle of its vertices.
  put(corners, at) {
    const n = this.normals;
    for (let axis = 0; axis < 3; ++axis) {
      let position = 0, normal = 0, color = 0;
      for (const v of corners) {
        position += this.positions[3 * v + axis];
        normal += n[3 * v + axis];
        color += this.colors[3 * v + axis];
      }
      this.positions[at + axis] = position / corners.length;
      n[at + axis] = normal;
      this.colors[at + axis] = color / corners.length;
    }
    const length = Math.hypot(n[at], n[at + 1], n[at + 2]) || 1;
    for (let axis = 0; axis < 3; ++axis) n[at + axis] /= length;
  }

  // Computes normals weighted by area. Vertices at the same place share a normal.
  updateNormals() {
    const { triangles, places } = this.mesh.surface;
    const p = this.positions;
    const n = this.normals.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (let corner = 0; corner < 3; ++corner) {
        const v = 3 * places[triangles[t + corner]];
        n[v] += x;
        n[v + 1] += y;
        n[v + 2] += z;
      }
    }
    // places[v] <= v, so a shared normal has unit length before it is copied.
    for (let v = 0; v < places.length; ++v) {
      const place = 3 * places[v];
      const length = place === 3 * v ? Math.hypot(n[place], n[place + 1], n[place + 2]) || 1 : 1;
      for (let i = 0; i < 3; ++i) n[3 * v + i] = n[place + i] / length;
    }
  }

  regionColors() {
    const { regionColors, clay } = this.performance;
    const colors = new Uint8Array(3 * this.regions.length);
    this.regions.forEach((region, i) => colors.set(region < 0 ? clay : regionColors[region], 3 * i));
    return colors;
  }

  updateColors(coloring) {
    if (coloring === 'regions') {
      this.mapper.setScalarModeToUseCellData();
      return;
    }
    this.mapper.setScalarModeToUsePointData();
    const { evenColors, clay, largest } = this.performance;
    const { rest } = this.mesh.poses;
    for (let v = 0; v < this.mesh.surface.vertices; ++v) {
      let color = clay;
      if (coloring === 'displacement') {
        const moved = Math.hypot(
          this.positions[3 * v] - rest[3 * v],
          this.positions[3 * v + 1] - rest[3 * v + 1],
          this.positions[3 * v + 2] - rest[3 * v + 2]);
        const share = largest > 0 ? Math.min(1, moved / largest) : 0;
        color = evenColors[Math.round(share * (evenColors.length - 1))];
      }
      this.colors.set(color, 3 * v);
    }
  }
}
