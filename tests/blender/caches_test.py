"""Mesh caches as sources and as results, and other meshes that move."""

import bpy
import numpy as np
from host import FRAMES, LAST, HostTest, command, mimetra, run_tests, sources
from mimetra_blender import results


class Caches(HostTest):
    def transferred(self, target, *options):
        """The command's positions of a target."""
        out = self.path / "out.npy"
        command("transfer", self.take, target, *options, "-o", out, "--force")
        return np.load(out)

    def mesh(self):
        """The target without expressions."""
        mesh = self.path / "mesh.ply"
        command("convert", self.actor, "-o", mesh, "--force")
        return mesh

    def test_a_target_without_shape_keys_gets_a_mesh_cache(self):
        bare = self.bare_target()
        bare.modifiers.new("fine", "SUBSURF").show_viewport = False
        for cache_format in ("PC2", "MDD"):
            with self.subTest(cache_format):
                bpy.ops.mimetra.transfer(target="bare", k=12, cache_format=cache_format,
                                         cache_folder=str(self.path / "caches"))
                modifier = bare.modifiers[0]
                self.assertEqual((modifier.name, modifier.cache_format), ("mimetra", cache_format))
                self.assertEqual(len(bare.modifiers), 2)
                self.assert_moves_like(bare, self.transferred(self.mesh(), "-k", 12))

    def test_vertex_space_gets_a_mesh_cache_where_there_are_shape_keys_too(self):
        bpy.ops.mimetra.transfer(target="target", k=12, space="vertex")
        self.assert_moves_like(self.target,
                               self.transferred(self.actor, "-k", 12, "--space", "vertex"))
        self.assertIsNone(self.target.data.shape_keys.animation_data)

    def test_shape_keys_take_the_place_of_a_mesh_cache(self):
        bpy.ops.mimetra.transfer(target="target", k=5, space="vertex")
        self.assertEqual(len(self.target.modifiers), 1)
        bpy.ops.mimetra.transfer(target="target", k=5)
        self.assertEqual(len(self.target.modifiers), 0)

    def test_a_cache_never_takes_the_place_of_a_file(self):
        bare = self.bare_target()
        folder = self.path / "twice"
        for expected in ("bare.pc2", "bare.002.pc2"):
            bpy.ops.mimetra.transfer(target="bare", full=True, cache_folder=str(folder))
            self.assertTrue(bare.modifiers[0].filepath.endswith(expected))
        self.assertEqual(len(list(folder.iterdir())), 2)

    def test_a_saved_file_has_its_caches_beside_it(self):
        bare = self.bare_target()
        bpy.ops.wm.save_as_mainfile(filepath=str(self.path / "scene.blend"))
        bpy.ops.mimetra.transfer(target="bare", full=True)
        self.assertEqual(bare.modifiers[0].filepath, "//mimetra/bare.pc2")
        self.assertTrue((self.path / "mimetra" / "bare.pc2").exists())

    def test_a_manifest_gives_motion_back(self):
        manifest = str(self.path / "align.json")
        poses = {frame: self.shown(self.source, frame) for frame in (1, 30, LAST)}
        bpy.ops.mimetra.align(on="all", manifest=manifest, cache_folder=str(self.path / "still"))
        still = bpy.data.objects["source align"]
        self.assertGreater(np.abs(self.shown(still, 30) - poses[30]).max(), 1e-3)
        with self.assertRaisesRegex(RuntimeError, "align.json: exists already"):
            bpy.ops.mimetra.align(manifest=manifest)
        self.activate(still)
        bpy.ops.mimetra.align(undo=manifest, cache_folder=str(self.path / "moving"))
        moving = bpy.data.objects["source align align"]
        for frame, pose in poses.items():
            self.assert_close(self.shown(moving, frame), pose, f"frame {frame}")

    def test_steps_between_frames_are_kept(self):
        bare = self.bare_target()
        bpy.ops.mimetra.transfer(target="bare", full=True, frame_start=11, frame_end=111,
                                 frame_step=20)
        expected = self.transferred(self.mesh(), "--full", "--frames", "10:111:20")
        for index, frame in enumerate(range(11, 112, 20)):
            self.assert_close(self.shown(bare, frame), expected[index], f"frame {frame}")

    def source_cache(self, cache_format):
        take = mimetra.Sequence.load(self.take)
        path = self.path / f"source.{cache_format.lower()}"
        take.save(path)
        bare = self.mesh_of("cached", take["positions"][0], take.faces)
        modifier = bare.modifiers.new("cache", "MESH_CACHE")
        modifier.cache_format, modifier.filepath = cache_format, str(path)
        modifier.frame_start = 1
        return bare

    def test_a_source_moves_by_a_mesh_cache(self):
        for cache_format in ("PC2", "MDD"):
            with self.subTest(cache_format):
                self.activate(self.source_cache(cache_format))
                bpy.ops.mimetra.transfer(target="target", k=12)
                out = self.path / "cached.npy"
                command("transfer", self.take, self.actor, "-k", 12, "--source-rest", "first", "-o",
                        out, "--force")
                self.assert_moves_like(self.target, np.load(out))

    def test_an_aligned_source_is_a_copy_with_a_mesh_cache(self):
        out = self.path / "still.npy"
        command("align", self.take, "--on", "all", "-o", out)
        bpy.ops.mimetra.align(on="all")
        self.assert_moves_like(bpy.data.objects["source align"], np.load(out))

    def test_a_simplified_and_a_subdivided_source_are_meshes_of_their_own(self):
        out = self.path / "fine.npy"
        command("subdivide", self.take, "-o", out)
        self.activate(self.source)
        bpy.ops.mimetra.subdivide()
        self.assert_moves_like(bpy.data.objects["source subdivide"], np.load(out))
        self.activate(self.source)
        bpy.ops.mimetra.simplify(share=0.3)
        simplified = bpy.data.objects["source simplify"]
        rest = self.shown(simplified, 1)
        given = self.shown(self.source, 1)
        self.assertEqual(len(rest), -(-3 * len(given) // 10))
        # Which vertices are kept may depend on the last digits, which Blender does not have.
        kept = [np.abs(given - vertex).max(axis=1).argmin() for vertex in rest]
        self.assertEqual(len(set(kept)), len(kept))
        for frame in FRAMES[:-1]:
            self.assert_close(self.shown(simplified, frame), self.shown(self.source, frame)[kept])

    def test_a_converted_source_has_the_regions_of_the_given_one(self):
        given = sources.rest_of(self.source.data)
        bpy.ops.mimetra.regions(k=6)
        regions = [group.name for group in self.source.vertex_groups]
        masks = sources.regions(self.source, "mimetra region")["masks"]
        # Twice a number has its digits: nothing is rounded otherwise.
        bpy.ops.mimetra.convert(scale=2, up="y-to-z")
        made = bpy.data.objects["source convert"]
        self.assert_close(sources.rest_of(made.data), 2 * given[:, [0, 2, 1]] * [1, -1, 1])
        made.vertex_groups.clear()
        self.activate(made)
        bpy.ops.mimetra.regions(k=6)
        self.assertEqual([group.name for group in made.vertex_groups], regions)
        np.testing.assert_array_equal(sources.regions(made, "mimetra region")["masks"], masks)

    def test_a_subdivided_source_has_the_neutral_of_the_given_one(self):
        given = sources.rest_of(self.source.data)
        bpy.ops.mimetra.subdivide(scheme="midpoint", frame_start=60)
        made = sources.rest_of(bpy.data.objects["source subdivide"].data)
        self.assert_close(made[:len(given)], given)

    def layers(self, subject):
        """Names of UV maps, materials, vertex groups and attributes."""
        mesh = subject.data
        return (mesh.uv_layers.keys(), mesh.materials.keys(), subject.vertex_groups.keys(),
                [each.name for each in mesh.attributes
                 if not each.is_internal and each.name != "material_index"])

    def test_a_mesh_of_other_faces_has_no_layers_which_are_named(self):
        mesh = self.source.data
        mesh.uv_layers.new(name="skin")
        for name in ("head", "teeth"):
            mesh.materials.append(bpy.data.materials.new(name))
        mesh.polygons.foreach_set("material_index", [1] * len(mesh.polygons))
        self.source.vertex_groups.new(name="mouth")
        mesh.attributes.new("dye", "FLOAT_COLOR", "POINT")
        warning = ("source {0}: has other faces than source, of which are left out: UV maps skin;"
                   " materials head, teeth; vertex groups mouth; attributes dye; bring them over")
        value, frames = self.made_of("convert", scale=2)
        made = results.show_sequence(bpy.context, value, self.source, frames, "source convert")
        self.assertEqual((self.layers(made), frames.notes), (self.layers(self.source), []))
        for operation, options in (("subdivide", {}), ("simplify", {"share": 0.5})):
            value, frames = self.made_of(operation, **options)
            name = f"source {operation}"
            made = results.show_sequence(bpy.context, value, self.source, frames, name)
            self.assertEqual(self.layers(made), ([], [], [], []))
            self.assertEqual(len(frames.notes), 1)
            self.assertTrue(frames.notes[0].startswith(warning.format(operation)))

    def made_of(self, operation, **options):
        """What an operation makes of two poses of the source's performance, and its frames."""
        take = mimetra.Sequence.load(self.take, frames="0:2")
        frames = results.Frames(bpy.context.scene, [1, 2], "PC2", str(self.path / "made"))
        return getattr(mimetra, operation)(take, **options).out, frames

    def test_a_source_moves_by_any_modifier_that_keeps_its_vertices(self):
        bend = self.source.modifiers.new("bend", "SIMPLE_DEFORM")
        bend.deform_method = "TWIST"
        bend.angle = 0
        bend.keyframe_insert("angle", frame=1)
        bend.angle = 0.4
        bend.keyframe_insert("angle", frame=LAST)
        self.source.modifiers.new("fine", "SUBSURF").levels = 1
        bpy.ops.mimetra.convert()
        copy = bpy.data.objects["source convert"]
        self.assertTrue(self.source.modifiers["fine"].show_viewport)
        self.source.modifiers["fine"].show_viewport = False
        for frame in (1, 60, LAST):
            expected = self.shown(self.source, frame)
            self.assert_close(self.shown(copy, frame), expected, f"frame {frame}")
        self.assertIsNone(copy.data.shape_keys)
        self.assertIsNotNone(self.source.data.shape_keys)

    def bound(self, before):
        """A Surface Deform modifier of the source behind one of type `before`, to which it is
        bound: it takes all vertices up by 10 until frame 11."""
        cage = self.mesh_of("cage", sources.rest_of(self.source.data),
                            sources.faces_of(self.source.data))
        self.source.modifiers.new("before", before)
        modifier = self.source.modifiers.new("follow", "SURFACE_DEFORM")
        modifier.target = cage
        self.bind(modifier)
        cage.shape_key_add(name="Basis", from_mix=False)
        up = cage.shape_key_add(name="up", from_mix=False)
        up.data.foreach_set("co", (sources.rest_of(cage.data) + np.float32([0, 0, 10])).ravel())
        for frame, up.value in ((1, 0), (11, 1)):
            up.keyframe_insert("value", frame=frame)
        return modifier

    def bind(self, modifier):
        bpy.context.scene.frame_set(1)
        with bpy.context.temp_override(object=self.source, active_object=self.source):
            bpy.ops.object.surfacedeform_bind(modifier=modifier.name)
        self.assertTrue(modifier.is_bound)

    def assert_converted(self, rise):
        """A conversion of the source has its motion and rises by so much, without a warning."""
        with self.assertNoLogs("mimetra", "WARNING"):
            bpy.ops.mimetra.convert(frame_end=11)
        copy = bpy.data.objects["source convert"]
        self.source.modifiers["before"].show_viewport = False
        poses = [self.shown(self.source, frame) for frame in (1, 11)]
        self.source.modifiers["before"].show_viewport = True
        self.assertAlmostEqual(np.median(poses[1] - poses[0], axis=0)[2], rise, delta=0.1)
        for frame, pose in zip((1, 11), poses):
            self.assert_close(self.shown(copy, frame), pose)
        bpy.data.objects.remove(copy)

    def test_a_modifier_that_is_bound_to_what_another_makes_is_named(self):
        modifier = self.bound("SUBSURF")
        with self.assertLogs("mimetra", "WARNING") as logs:
            bpy.ops.mimetra.convert(frame_end=2)
        self.assertRegex(logs.output[0], "source: the motion of the modifier 'follow' is missing:"
                                         ".* 'before' makes.*; move 'follow' before it")
        bpy.data.objects.remove(bpy.data.objects["source convert"])
        modifier.show_viewport = False
        self.assert_converted(0)
        modifier.show_viewport = True
        with bpy.context.temp_override(object=self.source, active_object=self.source):
            bpy.ops.object.surfacedeform_bind(modifier="follow")  # unbinds
            bpy.ops.object.modifier_move_to_index(modifier="follow", index=0)
        self.bind(modifier)
        self.assert_converted(10)

    def test_a_modifier_that_is_bound_behind_one_that_cuts_faces_moves(self):
        self.bound("TRIANGULATE")
        self.assert_converted(10)


if __name__ == "__main__":
    run_tests()
