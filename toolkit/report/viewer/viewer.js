// Player of a report: source and target side by side, under one camera.
import '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';
import vtkCamera from '@kitware/vtk.js/Rendering/Core/Camera';
import vtkCellPicker from '@kitware/vtk.js/Rendering/Core/CellPicker';
import vtkInteractorStyleTrackballCamera from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera';
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow';
import macro from '@kitware/vtk.js/macros';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor';

import { unpackPerformance } from './performance.js';
import { Surface } from './surface.js';

const element = (id) => document.getElementById(id);

// Rotates and zooms, without the keyboard commands of vtk.js. The player sets the clipping range.
const newStyle = macro.newInstance((publicAPI, model) => {
  vtkInteractorStyleTrackballCamera.extend(publicAPI, model, { autoAdjustCameraClippingRange: 0 });
  publicAPI.handleKeyPress = () => {};
}, 'playerStyle');

class Player {
  constructor(performance) {
    this.performance = performance;
    this.duration = performance.times.at(-1) - performance.times[0];
    this.time = 0;
    this.playing = false;
    this.camera = vtkCamera.newInstance({ parallelProjection: true });
    this.surfaces = performance.meshes.map((mesh) => new Surface(performance, mesh, this.camera));
    this.shown = this.surfaces;
    this.coloring = 'regions';
    this.createWindow(element('stage'));
    this.connectControls();
    this.resetView();
    this.resize();
    new ResizeObserver(() => this.resize()).observe(element('stage'));
  }

  createWindow(stage) {
    // The wheel scrolls the page, and zooms with Ctrl or Shift. vtk.js listens on the inner
    // element.
    stage.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !event.shiftKey) event.stopImmediatePropagation();
    }, { capture: true, passive: true });
    const inner = stage.appendChild(document.createElement('div'));
    this.window = vtkRenderWindow.newInstance();
    this.view = vtkOpenGLRenderWindow.newInstance();
    this.view.setContainer(inner);
    this.window.addView(this.view);
    for (const surface of this.surfaces) this.window.addRenderer(surface.renderer);
    const interactor = vtkRenderWindowInteractor.newInstance();
    interactor.setView(this.view);
    interactor.initialize();
    interactor.bindEvents(inner);
    interactor.setInteractorStyle(newStyle());
  }

  connectControls() {
    const slider = element('time');
    slider.max = String(this.duration);
    slider.step = String(this.duration / 1000);
    slider.addEventListener('input', () => {
      this.pause();
      this.seek(Number(slider.value));
    });
    element('play').addEventListener('click', () => (this.playing ? this.pause() : this.play()));
    this.showLegend();
    this.connectPicking(element('stage'));
    element('largest').textContent = this.performance.largest.toPrecision(3);
    element('coloring').addEventListener('change', (event) => {
      this.coloring = event.target.value;
      element('scale').hidden = this.coloring !== 'displacement';
      element('legend').hidden = this.coloring !== 'regions';
      this.draw();
    });
    // A report of one mesh has no choice of meshes.
    element('shown')?.addEventListener('change', (event) => {
      const name = event.target.value;
      this.shown = this.surfaces.filter(({ mesh }) => name === 'all' || mesh.role === name);
      this.layOut();
      this.draw();
    });
    element('reset').addEventListener('click', () => {
      this.resetView();
      this.draw();
    });
  }

  // Shows a box in the colour of each region.
  showLegend() {
    const there = new Set(this.surfaces.flatMap(({ regions }) => [...regions]));
    const entries = this.performance.regionColors.map((color, region) => {
      const entry = document.createElement('span');
      const box = entry.appendChild(document.createElement('i'));
      box.style.background = `rgb(${color.join(' ')})`;
      entry.append(String(region));
      entry.hidden = !there.has(region);
      return entry;
    });
    element('legend').replaceChildren('region', ...entries);
  }

  // Names what a click hits. Ignores drags, which rotate the meshes.
  connectPicking(stage) {
    const picker = vtkCellPicker.newInstance({ tolerance: 0 });
    let pressed = null;
    stage.addEventListener('pointerdown', (event) => { pressed = event; }, { capture: true });
    stage.addEventListener('pointerup', (event) => {
      const distance = pressed
        ? Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) : Infinity;
      if (distance > 3) return;
      const box = stage.getBoundingClientRect();
      const share = (event.clientX - box.left) / box.width;
      const surface = this.shown[Math.min(this.shown.length - 1,
        Math.floor(share * this.shown.length))];
      const [width, height] = this.view.getSize();
      picker.pick([share * width, (1 - (event.clientY - box.top) / box.height) * height, 0],
        surface.renderer);
      element('picked').textContent = surface.nameOf(picker.getCellId(), picker.getPickPosition());
    }, { capture: true });
  }

  resetView() {
    const { towardsEye, up, reach } = this.performance.view;
    const distance = 2 * reach;
    this.camera.setFocalPoint(0, 0, 0);
    this.camera.setPosition(...towardsEye.map((x) => x * distance));
    this.camera.setViewUp(...up);
    // The range contains all meshes at all times, from all sides.
    this.camera.setClippingRange(distance - 1.1 * reach, distance + 1.1 * reach);
    this.fittedScale = this.fittingScale();
    this.camera.setParallelScale(this.fittedScale);
  }

  // Half the height of a view that shows a whole mesh.
  fittingScale() {
    const { halfWidth, halfHeight } = this.performance.view;
    return Math.max(halfHeight, halfWidth / this.aspect());
  }

  // Keeps the user's zoom when the window changes its shape.
  fit() {
    const zoom = this.camera.getParallelScale() / this.fittedScale;
    this.fittedScale = this.fittingScale();
    this.camera.setParallelScale(this.fittedScale * zoom);
  }

  // Width divided by height of the view of one mesh.
  aspect() {
    const { clientWidth, clientHeight } = element('stage');
    return clientWidth / this.shown.length / clientHeight;
  }

  layOut() {
    for (const surface of this.surfaces) {
      const column = this.shown.indexOf(surface);
      surface.renderer.setDraw(column >= 0);
      if (column < 0) continue;
      const count = this.shown.length;
      surface.renderer.setViewport(column / count, 0, (column + 1) / count, 1);
    }
    for (const label of document.querySelectorAll('[data-role]')) {
      label.hidden = !this.shown.some(({ mesh }) => mesh.role === label.dataset.role);
    }
    this.fit();
  }

  resize() {
    const { clientWidth, clientHeight } = element('stage');
    if (clientWidth === 0) return;
    const ratio = window.devicePixelRatio || 1;
    this.view.setSize(Math.round(clientWidth * ratio), Math.round(clientHeight * ratio));
    this.layOut();
    this.draw();
  }

  seek(time) {
    this.time = time;
    element('time').value = String(time);
    this.draw();
  }

  play() {
    this.playing = true;
    element('play').textContent = 'Pause';
    let before = performance.now();
    const advance = (now) => {
      if (!this.playing) return;
      const time = this.time + Math.max(0, now - before) / 1000;
      before = now;
      this.seek(time > this.duration ? 0 : time);
      requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
  }

  pause() {
    this.playing = false;
    element('play').textContent = 'Play';
  }

  draw() {
    const { times } = this.performance;
    const now = times[0] + this.time;
    const first = Math.max(0, times.findLastIndex((time) => time <= now));
    const next = times[first + 1];
    const share = next === undefined ? 0 : (now - times[first]) / (next - times[first]);
    for (const surface of this.shown) {
      surface.show(first, share, this.coloring);
    }
    element('clock').textContent = `${now.toFixed(2)} s`;
    this.window.render();
  }
}

function start() {
  const performance = unpackPerformance(JSON.parse(element('performance').textContent));
  if (!document.createElement('canvas').getContext('webgl2')) {
    element('no-webgl').hidden = false;
    return;
  }
  element('player').hidden = false;
  new Player(performance);
}

start();
