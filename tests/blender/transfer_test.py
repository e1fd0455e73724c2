"""Transfer onto shape keys: the weights of the command, keyed."""

import json

import bpy
import numpy as np
from host import LAST, HostTest, column, command, mimetra, properties, run_tests, sources
from mimetra_blender import keying, results


class Transfer(HostTest):
    def expected(self, *options):
        """The command's weights {name: F} and positions."""
        out, weights = self.path / "out.npy", self.path / "weights.csv"
        command("transfer", self.take, self.actor, *options, "-o", out, "--weights-out", weights,
                "--force")
        names = [key.name for key in self.target.data.shape_keys.key_blocks[1:]]
        return {name: column(weights, name) for name in names}, np.load(out)

    def assert_performs(self, weights, positions):
        keyed = self.keyed(self.target)
        self.assertEqual(set(keyed), set(weights))
        for name, values in weights.items():
            # Of positions in single precision; the solution is as well conditioned as heads are.
            np.testing.assert_allclose(keyed[name], values, atol=2e-5, err_msg=name)
        self.assert_moves_like(self.target, positions)

    def test_keys_the_commands_weights(self):
        answer = bpy.ops.mimetra.transfer(target="target", k=30)
        self.assertEqual(answer, {"FINISHED"})
        self.assert_performs(*self.expected("-k", 30))
        self.assertEqual(len(self.target.modifiers), 0)

    def test_makes_a_rig_with_the_sources_shape_keys(self):
        self.bare_target()
        self.assertEqual(bpy.ops.mimetra.rig(target="bare"), {"FINISHED"})
        made = bpy.context.view_layer.objects.active
        names = [key.name for key in self.source.data.shape_keys.key_blocks]
        self.assertEqual([key.name for key in made.data.shape_keys.key_blocks], names)

    def test_takes_the_parameters_of_the_command(self):
        bpy.ops.mimetra.transfer(target="target", k=8, radius=0.2, ridge=0.1, region="support")
        self.assert_performs(*self.expected("-k", 8, "--radius", 0.2, "--ridge", 0.1, "--region",
                                            "support"))

    def test_takes_lengths_in_the_meshes_unit(self):
        bpy.ops.mimetra.transfer(target="target", k=12, radius=30, radius_absolute=True)
        self.assert_performs(*self.expected("-k", 12, "--radius", "30abs"))

    def test_uses_all_triangles_where_asked(self):
        bpy.ops.mimetra.transfer(target="target", full=True)
        self.assert_performs(*self.expected("--full"))

    def painted(self):
        """A vertex group of the source, and a file with its weights."""
        group = self.source.vertex_groups.new(name="mouth")
        heights = sources.coordinates(self.source.data.vertices)[:, 1]
        # Above the lips and across the cheeks, mm.
        weights = np.select([heights < -59, heights < -34], [1.0, 0.25], 0.0)
        for weight in (1.0, 0.25):
            group.add(np.flatnonzero(weights == weight).tolist(), weight, "REPLACE")
        path = self.path / "mouth.txt"
        np.savetxt(path, weights)
        return weights, path

    def test_paints_by_a_vertex_group_of_its_plain_name(self):
        weights, path = self.painted()
        out = self.path / "painted.npy"
        command("transfer", self.take, self.actor, "--paint", path, "--falloff", 0.05, "-o", out,
                "--regions-out", self.path / "painted.json")
        expected = json.loads((self.path / "painted.json").read_text())["weights"]
        for name in ("mouth", "field:mouth"):
            answer = bpy.ops.mimetra.transfer(target="target", paint=name, falloff=0.05,
                                              regions_out=True)
            self.assertEqual(answer, {"FINISHED"})
            self.assert_moves_like(self.target, np.load(out))
            shown = np.empty(len(weights), np.float32)
            self.source.data.attributes["mimetra weight"].data.foreach_get("value", shown)
            # Distances are along vertices in single precision.
            np.testing.assert_allclose(shown, expected, atol=1e-4)
            # Close to the border the weight is 1 - 1e-9, in single precision 1.
            np.testing.assert_array_equal(np.equal(expected, 1), weights == 1)
            self.assertTrue((shown[weights == 1] == 1).all())

    def test_vertex_groups_say_where_regions_may_lie(self):
        weights, _ = self.painted()
        bpy.ops.mimetra.regions(k=4, only="mouth")
        inside = np.empty(len(weights), np.int32)
        self.source.data.attributes["mimetra roi"].data.foreach_get("value", inside)
        self.assertTrue(inside.any())
        self.assertFalse(inside[weights == 0].any())

    def test_names_vertex_groups_that_are_not_there(self):
        self.painted()
        self.assert_fails("field 'nose' is not there; there are mouth", bpy.ops.mimetra.transfer,
                          target="target", paint="field:nose")

    def test_refuses_an_absolute_length_that_is_not_set(self):
        self.assert_fails("falloff: is to be absolute, and no length is set",
                          bpy.ops.mimetra.transfer, target="target", full=False,
                          falloff_absolute=True)

    def test_begins_a_falloff_at_a_length_that_can_be_seen(self):
        falloff = bpy.ops.mimetra.transfer.get_rna_type().properties["falloff"]
        self.assertAlmostEqual(falloff.default, 0.1)

    def test_reads_the_vertex_groups_that_are_named(self):
        groups = ("mouth", "nose")
        for values, expected in (((None, 3, "mouth.txt"), ()), (("field:mouth",), ("mouth",)),
                                 (("field:chin",), groups)):
            self.assertEqual(properties.groups_among(values, groups), expected)

    def test_leaves_the_scene_as_it_was(self):
        before = self.shown(self.source, 14)
        bpy.context.scene.frame_set(7)
        bpy.ops.mimetra.transfer(target="target", k=5)
        self.assertEqual(bpy.context.scene.frame_current, 7)
        self.assertEqual(bpy.context.active_object, self.source)
        np.testing.assert_array_equal(self.shown(self.source, 14), before)

    def test_keeps_polygons_and_other_shape_keys(self):
        sizes = [len(face.vertices) for face in self.target.data.polygons]
        self.assertIn(4, sizes)
        self.target.shape_key_add(name="mine", from_mix=False).mute = True
        bpy.ops.mimetra.transfer(target="target", k=5)
        self.assertEqual([len(face.vertices) for face in self.target.data.polygons], sizes)
        self.assertIn("mine", self.target.data.shape_keys.key_blocks)
        self.assertNotIn("mine", self.keyed(self.target))

    def test_weights_may_leave_the_range_of_sliders(self):
        for key in self.target.data.shape_keys.key_blocks[1:]:
            key.slider_max = 0.2
        bpy.ops.mimetra.transfer(target="target", full=True)
        self.assert_performs(*self.expected("--full"))

    def test_keys_the_frames_asked_for(self):
        bpy.ops.mimetra.transfer(target="target", full=True, frame_start=11, frame_end=51,
                                 frame_step=10)
        curve = self.target.data.shape_keys.animation_data.action.fcurves[0]
        self.assertEqual([point.co.x for point in curve.keyframe_points], [11, 21, 31, 41, 51])
        weights, _ = self.expected("--full", "--frames", "10:60:10")
        name = curve.data_path.split('"')[1]
        np.testing.assert_allclose([point.co.y for point in curve.keyframe_points], weights[name],
                                   atol=2e-5)

    def test_a_second_run_takes_the_place_of_the_first(self):
        bpy.ops.mimetra.transfer(target="target", k=5)
        bpy.ops.mimetra.transfer(target="target", k=30)
        self.assert_performs(*self.expected("-k", 30))

    def curve_of(self, name):
        """The curve that moves a shape key of the target, where there is one."""
        curves = self.target.data.shape_keys.animation_data.action.fcurves
        return curves.find(f'key_blocks["{name}"].value')

    def test_keys_outside_of_the_frames_stay(self):
        key = self.target.data.shape_keys.key_blocks["jawOpen"]
        for frame in (30, 200):
            key.value = 0.75
            key.keyframe_insert("value", frame=frame)
        for first, last in ((1, 60), (61, LAST)):
            bpy.ops.mimetra.transfer(target="target", full=True, frame_start=first, frame_end=last)
        self.assert_performs(*self.expected("--full"))
        by_hand = self.curve_of("jawOpen").keyframe_points[-1]
        self.assertEqual((*by_hand.co, by_hand.interpolation), (200, 0.75, "BEZIER"))

    def test_keys_within_the_frames_go(self):
        bpy.ops.mimetra.transfer(target="target", full=True)
        bpy.ops.mimetra.transfer(target="target", full=True, frame_start=11, frame_end=111,
                                 frame_step=50)
        for curve in self.target.data.shape_keys.animation_data.action.fcurves:
            self.assertEqual([point.co.x for point in curve.keyframe_points],
                             [*range(1, 11), 11, 61, 111, *range(112, LAST + 1)])

    def test_keys_and_caches_play_at_the_scenes_frames_where_time_is_stretched(self):
        twin = self.object_of("twin", f"{self.head}@identity001=1")
        render = bpy.context.scene.render
        for render.frame_map_old, render.frame_map_new in ((100, 200), (150, 100)):
            bpy.ops.mimetra.transfer(target="twin", full=True)
            bpy.ops.mimetra.convert()
            copy = bpy.context.scene.objects["source convert"]
            for frame in (1, 34, 60, 79, LAST):
                expected = self.shown(self.source, frame)
                self.assert_close(self.shown(twin, frame), expected, f"keys, frame {frame}")
                self.assert_close(self.shown(copy, frame), expected, f"cache, frame {frame}")
            bpy.data.objects.remove(copy)
            twin.data.shape_keys.animation_data_clear()

    def track(self, value):
        """An NLA track of the target's shape keys that holds jawOpen at a value."""
        keys = self.target.data.shape_keys
        action = bpy.data.actions.new("below")
        action.fcurves.new('key_blocks["jawOpen"].value').keyframe_points.insert(1, value)
        track = keys.animation_data_create().nla_tracks.new()
        track.name = "capture"
        track.strips.new("below", 1, action)
        return track

    def test_what_hides_the_keys_is_named(self):
        def muted_curve(animation, track):
            self.curve_of("jawOpen").mute = True

        def muted_group(animation, track):
            self.curve_of("jawOpen").group = animation.action.groups.new("face")
            animation.action.groups["face"].mute = True

        def modifier(animation, track):
            self.curve_of("jawOpen").modifiers.new("NOISE").strength = 3

        def solo(animation, track):
            track.is_solo = True

        def added(animation, track):
            animation.action_blend_type = "ADD"

        def added_to_nothing(animation, track):
            track.mute = True
            animation.action_blend_type = "ADD"

        def added_without_tracks(animation, track):
            animation.use_nla = False
            animation.action_blend_type = "ADD"

        def half(animation, track):
            animation.action_influence = 0.5

        def muted_modifier(animation, track):
            modifier(animation, track)
            self.curve_of("jawOpen").modifiers[0].mute = True

        def added_to_a_muted_strip(animation, track):
            track.strips[0].mute = True
            animation.action_blend_type = "ADD"

        def added_to_other_curves(animation, track):
            track.strips[0].action.fcurves[0].data_path = "eval_time"
            animation.action_blend_type = "ADD"

        cases = [(lambda *_: None, None), (added_to_nothing, None), (added_without_tracks, None),
                 (muted_modifier, None), (added_to_a_muted_strip, None),
                 (added_to_other_curves, None),
                 (solo, "target: the NLA track 'capture' .* plays alone"),
                 (added, "target: .* blended with the NLA track 'capture' \\(Add, influence 1\\)"),
                 (half, "target: .* 'capture' \\(Replace, influence 0.5\\)"),
                 (muted_curve, "target: the curves of the shape keys jawOpen are muted"),
                 (muted_group, "target: the curves of the shape keys jawOpen are muted"),
                 (modifier, "target: the curves of the shape keys jawOpen .* modifiers")]
        key = self.target.data.shape_keys.key_blocks["jawOpen"]
        values = {"jawOpen": np.array([0.25, 0.5])}
        for change, expected in cases:
            with self.subTest(expected or change.__name__):
                track = self.track(0.4)
                frames = results.Frames(bpy.context.scene, [10, 11], "PC2", "//")
                keying.set_keys(self.target, values, frames)
                self.assertEqual(frames.notes, [])
                change(self.target.data.shape_keys.animation_data, track)
                keying.set_keys(self.target, values, frames)
                bpy.context.scene.frame_set(11)
                bpy.context.view_layer.update()
                if expected:
                    self.assertNotAlmostEqual(key.value, 0.5, places=3)
                    self.assertEqual(len(frames.notes), 1)
                    self.assertRegex(frames.notes[0], expected)
                else:
                    self.assertAlmostEqual(key.value, 0.5, places=5)
                    self.assertEqual(frames.notes, [])
                self.target.data.shape_keys.animation_data_clear()

    def test_a_shared_action_stays_as_it_is(self):
        keys = self.target.data.shape_keys
        keys.animation_data_create().action = self.source.data.shape_keys.animation_data.action
        before = self.keyed(self.source)
        bpy.ops.mimetra.transfer(target="target", k=5)
        after = self.keyed(self.source)
        for name, values in before.items():
            np.testing.assert_array_equal(after[name], values)

    def test_vertex_groups_are_regions(self):
        out = self.path / "regions.json"
        command("regions", self.take, "-k", 4, "-o", out)
        bpy.ops.mimetra.regions(k=4)
        names = [group.name for group in self.source.vertex_groups]
        self.assertEqual(names, [f"mimetra region {index:02}" for index in range(len(names))])
        # Discs that are added are chosen by distances, which here are those of single precision.
        bpy.ops.mimetra.transfer(target="target", regions="mimetra region", complete=0)
        self.assert_performs(*self.expected("--regions", out, "--complete", 0))

    def test_head_motion_goes_into_a_mesh_cache(self):
        positions = np.load(self.take)
        turned = positions.copy()
        angles = np.linspace(0, 0.3, len(turned))
        for frame, angle in enumerate(angles):
            turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0],
                             [-np.sin(angle), 0, np.cos(angle)]])
            turned[frame] = positions[frame] @ turn.T
        path = self.path / "turned.pc2"
        mimetra.Sequence(turned, mimetra.Sequence.load(self.take).faces).save(path)
        modifier = self.source.modifiers.new("cache", "MESH_CACHE")
        modifier.cache_format, modifier.filepath, modifier.frame_start = "PC2", str(path), 1
        bpy.ops.mimetra.transfer(target="target", full=True, align="stable")
        self.assertEqual(self.target.modifiers[0].type, "MESH_CACHE")
        moved = self.shown(self.target, LAST) - self.shown(self.target, 1)
        self.assertGreater(np.abs(moved).max(), 10)


if __name__ == "__main__":
    run_tests()
