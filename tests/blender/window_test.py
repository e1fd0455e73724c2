"""In a window: the panel is drawn, Esc cancels, Undo takes back. The panel is in RESULTS/panel.png.
"""

import os
import pathlib
import threading
import time
import traceback

import bpy
import numpy as np
from host import HostTest, column
from mimetra_blender import settings

# Where the tab of the sidebar is, from the top right corner of the 3D view.
TAB = (14, 222)


class Window(HostTest):
    """Steps that Blender takes between its events: each yields seconds to wait."""

    def view(self):
        window = bpy.context.window_manager.windows[0]
        area = max(window.screen.areas, key=lambda area: area.width * area.height)
        region = next(region for region in area.regions if region.type == "WINDOW")
        return {"window": window, "area": area, "region": region}

    def press(self, kind, x=400, y=400):
        window = self.view()["window"]
        for value in ("PRESS", "RELEASE"):
            window.event_simulate(type=kind, value=value, x=x, y=y)

    def start(self, name, **options):
        with bpy.context.temp_override(**self.view()):
            return getattr(bpy.ops.mimetra, name)("INVOKE_DEFAULT", **options)

    def keys(self):
        return bpy.data.objects["target"].data.shape_keys

    def cancels(self):
        self.assertEqual(self.start("transfer", target="target", k=40, iterations=1000,
                                    tolerance=0), {"RUNNING_MODAL"})
        yield 0.5
        self.press("ESC")
        started = time.monotonic()
        yield 0.5
        self.assertLess(time.monotonic() - started, 5)
        self.assertIsNone(self.keys().animation_data)
        self.assertEqual(bpy.context.scene.frame_current, 7)
        # It has ended: the next one begins.
        self.assertEqual(self.start("info"), {"RUNNING_MODAL"})
        while "mimetra info" not in bpy.data.texts:
            yield 0.2

    def ends_when_another_file_is_opened(self):
        self.start("transfer", target="target", k=40, iterations=1000, tolerance=0)
        yield 0.5
        self.setUp()
        self.assertEqual(threading.active_count(), 1)
        self.view()["area"].type = "TEXT_EDITOR"
        yield 0.5
        self.assertIsNone(self.keys().animation_data)

    def finishes_and_is_undone(self):
        with bpy.context.temp_override(**self.view()):
            bpy.ops.ed.undo_push(message="two heads")
        self.start("transfer", target="target", k=8, regions_out=True)
        while not self.keys().animation_data:
            yield 0.2
        yield 0.5
        self.assertEqual(len(self.keyed(bpy.data.objects["target"])), 12)
        self.assertEqual(len(bpy.data.objects["source"].vertex_groups), 8)
        with bpy.context.temp_override(**self.view()):
            bpy.ops.ed.undo()
        yield 0.5
        self.assertIsNone(self.keys().animation_data)
        self.assertEqual(len(bpy.data.objects["source"].vertex_groups), 0)
        with bpy.context.temp_override(**self.view()):
            bpy.ops.ed.redo()
        yield 0.5
        self.assertEqual(len(self.keyed(bpy.data.objects["target"])), 12)

    def watched_panel(self):
        """Whether what the panel sets the operator to has been handed on, and the errors in it."""
        drawn, errors = [], []

        def copy(group, operation, operator, copy=settings.copy):
            try:
                copy(group, operation, operator)
                drawn.append((operation.name, operator.target))
            except Exception:
                errors.append(traceback.format_exc())

        settings.copy = copy
        return drawn, errors

    def shows_the_panel(self):
        bpy.ops.mimetra.transfer(target="target", k=30, regions_out=True)
        source, target = bpy.data.objects["source"], bpy.data.objects["target"]
        target.location.x = 200
        self.view()["area"].type = "VIEW_3D"
        yield 0.5
        for each in (source, target):
            each.rotation_euler.x = np.pi / 2
            each.data.polygons.foreach_set("use_smooth", [True] * len(each.data.polygons))
            each.data.update()
        view = self.view()
        space = view["area"].spaces.active
        space.show_region_ui = True
        space.shading.color_type = "VERTEX"
        space.overlay.show_overlays = False
        space.clip_end = 10000
        bpy.context.scene.mimetra.transfer.target = target
        widest = column(self.head / "performance.csv", "jawOpen").argmax()
        bpy.context.scene.frame_set(int(widest) + 1)
        with bpy.context.temp_override(**view):
            bpy.ops.view3d.view_axis(type="FRONT")
            bpy.ops.view3d.view_all()
        yield 1
        drawn, errors = self.watched_panel()
        area = view["area"]
        self.press("LEFTMOUSE", area.x + area.width - TAB[0], area.y + area.height - TAB[1])
        yield 2
        self.assertEqual(errors, [])
        self.assertIn(("transfer", "target"), drawn)
        path = pathlib.Path(os.environ["RESULTS"]) / "panel.png"
        bpy.ops.screen.screenshot(filepath=str(path))

    def steps(self):
        self.setUp()
        # Drawing heads without a graphics card would take most of the time.
        self.view()["area"].type = "TEXT_EDITOR"
        bpy.context.preferences.system.viewport_aa = "OFF"
        yield 0.5
        yield from self.cancels()
        yield from self.ends_when_another_file_is_opened()
        yield from self.finishes_and_is_undone()
        yield from self.shows_the_panel()


def run():
    """The next step, or the end of Blender."""
    try:
        return next(steps)
    except StopIteration:
        print("OK", flush=True)
        os._exit(0)
    except BaseException:
        traceback.print_exc()
        os._exit(1)


Window.setUpClass()
steps = Window().steps()
bpy.app.timers.register(run, first_interval=1, persistent=True)
