"""A transferred performance renders: Cycles on the processor, in RESULTS/transfer.png."""

import os
import pathlib

import bpy
import numpy as np
from host import HostTest, column, run_tests
from mathutils import Vector


class Picture(HostTest):
    def material(self, layer):
        """White, or the colours of an attribute."""
        made = bpy.data.materials.new("clay")
        made.use_nodes = True
        shader = made.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (0.8, 0.72, 0.66, 1)
        shader.inputs["Specular"].default_value = 0.2
        if layer:
            colors = made.node_tree.nodes.new("ShaderNodeVertexColor")
            colors.layer_name = layer
            made.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
        return made

    def light_and_camera(self, width):
        scene = bpy.context.scene
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        camera.data.type, camera.data.ortho_scale = "ORTHO", width
        camera.data.clip_end = 10 * width
        camera.location = (0, -3 * width, 0)
        camera.rotation_euler = (np.pi / 2, 0, 0)
        sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
        sun.data.energy = 3
        sun.rotation_euler = Vector((-0.5, 0.6, -0.7)).to_track_quat("-Z", "Y").to_euler()
        for each in (camera, sun):
            scene.collection.objects.link(each)
        scene.camera = camera
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True
        scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.5, 0.5, 0.5, 1)

    def place(self, subjects):
        """Side by side, upright; returns the width of all."""
        bpy.context.scene.frame_set(1)
        bpy.context.view_layer.update()
        step = 1.15 * max(each.dimensions.x for each in subjects)
        for index, each in enumerate(subjects):
            each.rotation_euler.x = np.pi / 2
            middle = np.mean([corner[:] for corner in each.bound_box], axis=0)
            each.location = ((index - (len(subjects) - 1) / 2) * step, 0, -middle[1])
            each.data.polygons.foreach_set("use_smooth", [True] * len(each.data.polygons))
        return step * len(subjects)

    def rendered(self, name):
        """A picture of the frame in which the mouth is open most."""
        scene = bpy.context.scene
        scene.frame_set(int(column(self.head / "performance.csv", "jawOpen").argmax()) + 1)
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising = 6, False
        scene.render.resolution_x, scene.render.resolution_y = 600, 480
        path = pathlib.Path(os.environ["RESULTS"]) / name
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(path), check_existing=False)
        pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(image.size[1], image.size[0], 4)[:, :, :3]

    def test_the_target_moves_in_the_picture(self):
        subjects = [self.source, self.target]
        self.light_and_camera(self.place(subjects))
        for subject, layer in zip(subjects, ["mimetra region color", None]):
            subject.data.materials.append(self.material(layer))
        still = self.rendered("still.png")
        bpy.ops.mimetra.transfer(target="target", k=30, regions_out=True)
        moved = self.rendered("transfer.png")
        half = still.shape[1] // 2
        # The regions have colours on the left; the face on the right opens its mouth.
        left = np.ptp(moved[:, :half], axis=2).max()
        self.assertGreater(left, 0.3)
        changed = np.abs(moved[:, half:] - still[:, half:]).max(axis=2) > 0.1
        self.assertGreater(changed.mean(), 0.005)
        self.assertLess(changed.mean(), 0.3)


if __name__ == "__main__":
    run_tests()
