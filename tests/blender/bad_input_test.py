"""What goes wrong: the library's words in Blender's error, and nothing has changed."""

import threading
import time

import bpy
import numpy as np
from host import HostTest, run_tests
from mimetra_blender import mimetra, operators


class BadInput(HostTest):
    def tearDown(self):
        """Whatever failed left the scene as it was."""
        self.assertEqual(bpy.context.scene.frame_current, 7)
        self.assertEqual(len(self.target.modifiers), 0)
        self.assertIsNone(self.target.data.shape_keys.animation_data)
        self.assertEqual(len(self.source.vertex_groups), 0)
        self.assertEqual(threading.active_count(), 1)
        self.assertNotIn("source align", bpy.data.objects)

    def test_a_target_without_shape_keys_has_no_weights(self):
        self.bare_target()
        self.assert_fails("bare: has no expressions", bpy.ops.mimetra.transfer, target="bare", k=3,
                          space="blendshape")

    def test_another_topology(self):
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.active_object.name = "cube"
        self.activate(self.source)
        self.assert_fails("cube: 8 vertices, expected 5126 as in the source",
                          bpy.ops.mimetra.transfer, target="cube", full=True)

    def test_no_target(self):
        self.assert_fails("transfer: expected an object as target", bpy.ops.mimetra.transfer)
        self.assert_fails("nobody: expected a mesh object as target", bpy.ops.mimetra.transfer,
                          target="nobody")

    def test_no_motion(self):
        self.source.data.shape_keys.animation_data_clear()
        self.assert_fails("nothing moves: all 120 frames", bpy.ops.mimetra.regions, k=3)

    def test_frames_the_wrong_way_round(self):
        self.assert_fails("expected an end of at least 20, found 10", bpy.ops.mimetra.regions,
                          frame_start=20, frame_end=10)

    def test_vertex_groups_that_are_not_there(self):
        self.assert_fails("source: no vertex group begins with 'mouth'",
                          bpy.ops.mimetra.transfer, target="target", regions="mouth")

    def test_files_that_are_not_there(self):
        self.assert_fails("nothing.h5", bpy.ops.mimetra.regions, components="/nothing.h5")
        self.assert_fails("fit: expected a path as landmarks", bpy.ops.mimetra.fit)

    def test_a_number_of_vertices_that_changes_over_time(self):
        geometry = self.source.modifiers.new("nodes", "NODES")
        group = bpy.data.node_groups.new("twice", "GeometryNodeTree")
        group.inputs.new("NodeSocketGeometry", "Geometry")
        group.outputs.new("NodeSocketGeometry", "Geometry")
        first, last = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        join = group.nodes.new("GeometryNodeSubdivideMesh")
        group.links.new(first.outputs[0], join.inputs[0])
        group.links.new(join.outputs[0], last.inputs[0])
        geometry.node_group = group
        self.assert_fails("source: [0-9]+ vertices in frame 1, expected 5126 as in its mesh",
                          bpy.ops.mimetra.regions, k=3)

    def test_a_mesh_without_faces(self):
        mesh = bpy.data.meshes.new("points")
        mesh.from_pydata([(0, 0, 0), (1, 0, 0)], [], [])
        points = bpy.data.objects.new("points", mesh)
        bpy.context.collection.objects.link(points)
        self.activate(points)
        self.assert_fails("points: has no faces", bpy.ops.mimetra.info)

    def test_driven_shape_keys(self):
        key = self.target.data.shape_keys.key_blocks["jawOpen"]
        key.driver_add("value").driver.expression = "0.5"
        self.assert_fails("the shape key 'jawOpen' is driven", bpy.ops.mimetra.transfer,
                          target="target", k=3)
        key.driver_remove("value")
        self.target.data.shape_keys.animation_data_clear()

    def test_shape_keys_whose_nla_strip_is_edited(self):
        keys = self.target.data.shape_keys
        animation = keys.animation_data_create()
        track = animation.nla_tracks.new()
        strip = track.strips.new("edited", 1, self.source.data.shape_keys.animation_data.action)
        track.select = strip.select = True
        animation.use_tweak_mode = True
        self.assert_fails("target: an NLA strip of its shape keys is being edited; leave Tweak",
                          bpy.ops.mimetra.transfer, target="target", k=3)
        animation.use_tweak_mode = False
        keys.animation_data_clear()

    def test_a_file_that_exists(self):
        path = self.path / "kept.h5"
        path.write_bytes(b"kept")
        self.assert_fails("kept.h5: exists already", bpy.ops.mimetra.transfer, target="target",
                          k=3, components_out=str(path))
        self.assertEqual(path.read_bytes(), b"kept")
        path.unlink()

    def test_a_source_that_blender_does_not_move(self):
        self.source.hide_viewport = True
        self.assert_fails("source: is disabled in viewports", bpy.ops.mimetra.info)
        self.source.hide_viewport = False
        self.source.show_only_shape_key = True
        self.assert_fails("source: shows only the shape key", bpy.ops.mimetra.info)
        self.source.show_only_shape_key = False

    def test_a_folder_that_cannot_be_written(self):
        self.bare_target()
        self.assert_fails("/proc/mimetra: cannot write the mesh cache", bpy.ops.mimetra.transfer,
                          target="bare", full=True, cache_folder="/proc/mimetra")

    def test_a_folder_that_cannot_be_written_without_a_target(self):
        self.assert_fails("/proc/mimetra: cannot write the mesh cache", bpy.ops.mimetra.align,
                          cache_folder="/proc/mimetra")

    def test_a_file_that_cannot_be_written(self):
        for path, text in [("/proc/mimetra/x.h5", "/proc/mimetra/x.h5"),
                           (str(self.path / "x.npy"), "components can be written as")]:
            self.assert_fails(text, bpy.ops.mimetra.transfer, target="target", k=3,
                              components_out=path)

    def test_cancelling_ends_the_computation(self):
        poses = np.random.default_rng(1).normal(size=(60, 5126, 3))
        take = mimetra.Sequence(poses, mimetra.Sequence.load(self.take).faces)
        steps = operators._computed(mimetra.operations["decompose"], {"sequence": take},
                                    {"k": 40, "tolerance": 0, "iterations": 100000})
        next(steps)
        self.assertEqual(threading.active_count(), 2)
        begun = time.monotonic()
        steps.close()  # as Esc does
        self.assertEqual(threading.active_count(), 1)
        self.assertLess(time.monotonic() - begun, 30)


if __name__ == "__main__":
    run_tests()
