"""Operations of plugins: filters with their parameters, and the command's results."""

import unittest

from host import *


class ThirdPartyOperations(HostTest):
    def setUp(self):
        self.source = simple.mimetraSequence(FileName=str(self.sample.take))
        self.source.UpdatePipelineInformation()

    def remade(self, operation, source, time=None):
        return at(simple.mimetraRemake(Input=source, Operation=operation), time)

    def assert_refused(self, words, filter):
        with Messages() as messages:
            self.assertEqual(at(filter).GetNumberOfPoints(), 0)
        self.assertIn(words, messages.text)
        self.assertEqual(messages.text.count("ERR"), 1, messages.text)

    def test_has_the_parameters_of_the_plugin(self):
        smooth = simple.mimetraSmooth(Input=self.source)
        self.assertEqual(smooth.Strength, 0.5)
        self.assertEqual(smooth.Iterations, 1)
        for name in ["Strength", "Iterations"]:
            self.assertEqual(smooth.GetProperty(name).GetPanelVisibility(), "default")

    def test_has_the_ranges_of_the_plugin(self):
        smooth = simple.mimetraSmooth(Input=self.source)
        for name, kind, ends in [("Iterations", "Int", (1, 1000000)), ("Strength", "Double", (0, 1))]:
            range = smooth.GetProperty(name).FindDomain(f"vtkSM{kind}RangeDomain")
            self.assertTrue(range.GetMinimumExists(0) and range.GetMaximumExists(0))
            self.assertEqual((range.GetMinimum(0), range.GetMaximum(0)), ends)

    def test_keeps_parameters_and_ports_of_one_name_apart(self):
        remake = simple.mimetraRemake(Input=self.source)
        self.assertEqual((remake.Input, remake.InputValue), (self.source, 7))
        self.assertEqual(remake.Operation, "asked")

    def test_lists_the_choices_of_a_parameter_without_a_default(self):
        hint = simple.mimetraRemake(Input=self.source).GetProperty("Hint")
        self.assertEqual(hint.GetDocumentation().GetDescription(),
                         "no default; one of triangles turned halved doubled asked nothing; "
                         "empty for none")

    def test_smooths_as_the_command_does(self):
        smooth = simple.mimetraSmooth(Input=self.source, Strength=0.3, Iterations=2)
        array = self.sample / "smooth.npy"
        mimetra("smooth", self.sample.take, "--strength", 0.3, "--iterations", 2, "-o", array)
        expected = simple.mimetraSequence(FileName=str(array))
        expected.UpdatePipelineInformation()
        for time in self.source.TimestepValues:
            self.assert_same(points(at(smooth, time)), points(at(expected, time)))
        before = points(at(smooth))
        smooth.Strength = 1
        self.assertFalse(np.array_equal(points(at(smooth)), before))

    def test_shows_the_fields_of_the_command(self):
        speed = simple.mimetraSpeed(Input=self.source)
        mimetra("speed", self.sample.take, "-o", self.sample / "speed.pvd")
        expected = at(simple.PVDReader(FileName=str(self.sample / "speed.pvd")))
        found = at(speed)
        for name in ["speed", "top_speed"]:
            shown = point_array(found, name)
            self.assertGreater(shown.max(), 0)
            self.assert_same(shown, point_array(expected, name), name)

    def test_shows_a_mesh_with_other_faces_as_its_own(self):
        positions, quads = grid()
        source = self.series_of("faces", moving())
        found = self.remade("triangles", source, 2)
        self.assertEqual(found.GetNumberOfPolys(), 2 * len(quads))
        self.assert_same(cell_array(found, "index"), np.arange(2 * len(quads), dtype=np.int32))
        self.assert_same(points(found), points(at(source, 2)))
        turned = self.remade("turned", source, 2)
        self.assertEqual(list(polygons(turned)[1]), [v for quad in quads for v in quad][::-1])
        self.assert_same(point_array(turned, "displacement"), np.full(36, 7, dtype=np.int32))
        self.assert_same(points(turned), points(at(source, 2)))

    def test_passes_the_data_of_the_input_through_on_its_own_faces(self):
        mesh = mesh_of(*grid())
        weight = np.arange(36, dtype=np.float64)
        array = numpy_to_vtk(weight, deep=True)
        array.SetName("weight")
        mesh.GetPointData().AddArray(array)
        normals = numpy_to_vtk(np.tile([0., 0., 1.], (36, 1)), deep=True)
        normals.SetName("Normals")
        mesh.GetPointData().SetNormals(normals)
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(mesh)
        # The shape stays, and with it the normals; smoothing changes it.
        same, smooth = self.remade("asked", source), at(simple.mimetraSmooth(Input=source))
        for found, has_normals in [(same, True), (smooth, False)]:
            self.assert_same(point_array(found, "weight"), weight)
            self.assertEqual(found.GetPointData().HasArray("Normals"), has_normals)
            self.assertEqual(found.GetNumberOfPolys(), 25)

    def test_shows_a_table_beside_the_mesh(self):
        remake = simple.mimetraRemake(Input=self.source)
        self.assertGreater(at(remake).GetNumberOfPoints(), 0)
        self.assertEqual(list(column(at(remake, port=1), "column")), [0])
        self.assertEqual(remake.SMProxy.GetOutputPortName(1), "Rows")

    def test_shows_the_frame_of_the_time(self):
        source = self.series_of("halved", moving())
        for time, frame in [(0, 0), (2, 2), (3, 2)]:
            self.assert_same(points(self.remade("halved", source, time)),
                             points(at(source, frame)))

    def test_hands_over_and_shows_fields(self):
        meshes = moving()
        heights = []
        for mesh in meshes:
            heights.append(points(mesh)[:, 2].astype(np.float32))
            array = numpy_to_vtk(heights[-1], deep=True)
            array.SetName("height")
            mesh.GetPointData().AddArray(array)
        source = self.series_of("heights", meshes)
        for time in [1, 2]:
            found = self.remade("doubled", source, time)
            self.assert_same(point_array(found, "height"), 2 * heights[0])
            # What is handed on as it is stays the input's, which changes over time.
            found = self.remade("asked", source, time)
            self.assert_same(point_array(found, "height"), heights[time])

    def test_keeps_the_rest_pose_of_a_new_shape(self):
        source = simple.mimetraSequence(FileName=str(self.sample.head),
                                        Weights=str(self.sample.weights))
        found = at(simple.mimetraSmooth(Input=source, Strength=0.25), 1)
        rest = point_array(found, "mimetra_rest")
        self.assert_same(point_array(found, "displacement"),
                         (points(found) - rest).astype(np.float32))

    def test_says_what_it_wants(self):
        self.assertEqual(self.remade("asked", self.source).GetNumberOfPoints(),
                         at(self.source).GetNumberOfPoints())
        self.assert_refused("made nothing for its output 'out'",
                            simple.mimetraRemake(Input=self.source, Operation="nothing"))

    def test_reads_further_inputs_from_files(self):
        replace = simple.mimetraReplace(Input=self.source)
        self.assert_refused("Other: expected the other take, found nothing", replace)
        smooth = self.sample / "other.npy"
        mimetra("smooth", self.sample.take, "-o", smooth)
        replace.Other = str(smooth)
        self.assert_same(points(at(replace, 0)), np.load(smooth)[0])

    def test_takes_models_from_the_pipeline_or_from_files(self):
        source = self.series_of("follow", moving())
        actor = simple.TrivialProducer()
        actor.GetClientSideObject().SetOutput(mesh_of(*grid()))
        follow = simple.mimetraFollow(Input=source, Actor=actor)
        self.assert_same(points(at(follow, 2)), points(at(source, 2)))
        follow.ActorFile = str(self.sample.head)
        self.assert_refused("the actor has other vertices", follow)

    def test_stops_where_the_user_aborts(self):
        smooth = simple.mimetraSmooth(Input=self.source)
        algorithm = smooth.GetClientSideObject()

        def abort(*_):
            if algorithm.GetProgress() > 0.6:
                algorithm.SetAbortExecute(1)

        observer = algorithm.AddObserver("ProgressEvent", abort)
        with Messages() as messages:
            self.assertEqual(at(smooth, 0).GetNumberOfPoints(), 0)
        self.assertEqual(messages.text, "")
        algorithm.RemoveObserver(observer)
        self.assertGreater(at(smooth, 0).GetNumberOfPoints(), 0)

    def test_tells_of_a_plugin_that_cannot_be_used(self):
        folder = self.sample / "plugins"
        folder.mkdir()
        (folder / "garbage.so").write_text("no library")
        script = self.sample / "list.py"
        script.write_text("from paraview import simple\nsimple.mimetraSmooth\n")
        path = f"{folder}:{os.environ['MIMETRA_PLUGIN_PATH']}"
        done = subprocess.run([os.environ["PVPYTHON"], str(script)], capture_output=True, text=True,
                              env=environment_of_its_own(MIMETRA_PLUGIN_PATH=path))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"plugins: {folder}/garbage.so: ", done.stderr)
        self.assertIn("it is left out", done.stderr)
        self.assertIn("operation 'sequence': mimetra Sequence is something else in ParaView",
                      done.stderr)

    def test_comes_back_with_a_saved_state(self):
        smooth = simple.mimetraSmooth(Input=self.source, Strength=0.25, Iterations=3)
        expected = points(at(smooth, 0))
        state = str(self.sample / "state.pvsm")
        simple.SaveState(state)
        simple.ResetSession()
        simple.LoadState(state)
        found = simple.FindSource("mimetraSmooth1")
        self.assertEqual((found.Strength, found.Iterations), (0.25, 3))
        self.assert_same(points(at(found, 0)), expected)

    def test_tells_of_what_fails(self):
        with Messages() as messages:
            at(simple.mimetraSpeed(Input=self.series_of("still", moving(1))))
        self.assertIn("speed sample: speed: one frame has no speed", messages.text)


if __name__ == "__main__":
    run_tests()
