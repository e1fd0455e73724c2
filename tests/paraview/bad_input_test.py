"""What is no sequence of meshes: an error in the output window in the library's words, no crash."""

import unittest

from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkUnstructuredGrid

from host import *

FILTERS = {"RegionsofInterest": {"K": 3}, "SparseComponents": {"K": 3},
           "RegionTransfer": {"K": 3}, "GeodesicDistance": {}, "mimetraAlign": {},
           "mimetraCheck": {}}
SERIES_FILTERS = [name for name in FILTERS if name != "GeodesicDistance"]


def size_of(data):
    """Cells, blocks or rows."""
    if data.IsA("vtkTable"):
        return data.GetNumberOfRows()
    return data.GetNumberOfCells() if data.IsA("vtkPolyData") else data.GetNumberOfBlocks()


class BadInput(HostTest):
    def source_of(self, data):
        source = simple.TrivialProducer()
        source.GetClientSideObject().SetOutput(data)
        return source

    def assert_refused(self, source, words, filters=FILTERS, time=None, **properties):
        target = simple.mimetraSequence(FileName=str(self.sample.head))
        for name in filters:
            inputs = {"Target": target} if name == "RegionTransfer" else {}
            with self.subTest(filter=name), Messages() as messages:
                filter = getattr(simple, name)(Input=source, **inputs,
                                               **{**FILTERS[name], **properties})
                self.assertEqual(size_of(at(filter, time)), 0)
                self.assertIn(words, messages.text)
                self.assertEqual(messages.text.count("ERR"), 1, messages.text)

    def test_points_without_cells(self):
        self.assert_refused(self.source_of(mesh_of(grid()[0], [])), "has no faces")

    def test_nothing_at_all(self):
        self.assert_refused(self.source_of(vtkPolyData()), "has no points")

    def test_an_unstructured_grid(self):
        self.assert_refused(self.source_of(vtkUnstructuredGrid()),
                            "expected a surface of polygons (vtkPolyData), found "
                            "vtkUnstructuredGrid; apply Extract Surface")

    def test_blocks(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, moving()[0])
        self.assert_refused(self.source_of(blocks), "found vtkMultiBlockDataSet")

    def test_another_vertex_count_at_a_later_time(self):
        meshes = moving()
        meshes[2] = mesh_of(*grid(5))
        self.assert_refused(self.series_of("count", meshes),
                            "time 2: 25 vertices, expected 36 as at time 0", SERIES_FILTERS)

    def test_other_faces_at_a_later_time(self):
        meshes = moving()
        positions, quads = grid()
        meshes[3] = mesh_of(positions, [quads[0], quads[1][::-1]] + quads[2:])
        self.assert_refused(self.series_of("faces", meshes), "time 3: face 1 is not that of time 0",
                            SERIES_FILTERS)

    def test_a_position_that_is_not_a_number(self):
        meshes = moving()
        positions = grid()[0]
        positions[7, 1] = np.nan
        meshes[1] = mesh_of(positions, grid()[1])
        series = self.series_of("nan", meshes)
        self.assert_refused(series, "time 1: point 7 has no usable position", SERIES_FILTERS)
        self.assert_refused(series, "the mesh: point 7 has no usable position", ["GeodesicDistance"], 1)

    def test_a_rest_pose_that_is_not_a_number(self):
        meshes = moving()
        for mesh in meshes:
            displacement = points(mesh) - grid()[0]
            displacement[4, 2] = np.nan
            array = numpy_to_vtk(displacement, deep=True)
            array.SetName("displacement")
            mesh.GetPointData().AddArray(array)
        self.assert_refused(self.series_of("rest", meshes),
                            "time 0: rest pose: vertex 4 has no usable position", SERIES_FILTERS)

    def test_triangle_strips(self):
        strips = vtkCellArray()
        strips.InsertNextCell(4, [0, 1, 6, 7])
        mesh = mesh_of(grid()[0], [])
        mesh.SetStrips(strips)
        self.assert_refused(self.source_of(mesh), "has triangle strips; apply ParaView's Triangulate")

    def test_one_time_step_does_not_spoil_the_others_of_geodesic_distance(self):
        meshes = moving()
        meshes[1] = mesh_of(*grid(1))
        filter = simple.GeodesicDistance(Input=self.series_of("spoilt", meshes))
        with Messages() as messages:
            counts = [at(filter, time).GetNumberOfPoints() for time in [0, 1, 2, 0]]
        self.assertEqual(counts, [36, 0, 36, 36])
        self.assertEqual(messages.text.count("ERR"), 1, messages.text)

    def test_a_polygon_of_two_corners(self):
        self.assert_refused(self.source_of(mesh_of(grid()[0], [[0, 1, 6], [0, 1]])),
                            "the mesh: face 1 has 2 corners, expected at least 3")

    def test_one_frame_where_motion_is_needed(self):
        self.assert_refused(self.source_of(mesh_of(*grid())),
                            "the sequence has one frame; a decomposition needs at least two",
                            ["RegionsofInterest", "SparseComponents"])

    def test_more_components_than_vertices(self):
        self.assert_refused(self.series_of("good", moving()),
                            "'K': 37 components asked for, the mesh has 36 vertices",
                            ["RegionsofInterest", "SparseComponents"], K=37)

    def test_a_value_out_of_its_range(self):
        self.assert_refused(self.series_of("range", moving()),
                            "'Coverage': expected a number from 1e-09 to 1, found '7'",
                            ["RegionsofInterest"], Coverage="7")
        self.assert_refused(self.series_of("length", moving()), "found 'wide'",
                            ["RegionsofInterest"], Radius="wide")

    def test_a_source_vertex_that_the_mesh_does_not_have(self):
        self.assert_refused(self.source_of(mesh_of(*grid())),
                            "'Source': vertex 36, the mesh has 36 (0-based)", ["GeodesicDistance"],
                            Source="36")

    def test_a_target_with_other_vertices(self):
        self.assert_refused(self.series_of("target", moving()), "vertices, expected 36 as in "
                            "the source", ["RegionTransfer"])

    def test_says_so_once_while_playing(self):
        meshes = moving()
        meshes[2] = mesh_of(*grid(5))
        filter = simple.RegionsofInterest(Input=self.series_of("playing", meshes), K=3)
        with Messages() as messages:
            for time in [0, 1, 2, 3, 0, 1]:
                at(filter, time)
        self.assertEqual(messages.text.count("ERR"), 1, messages.text)

    def test_a_filter_recovers_when_its_input_is_put_right(self):
        bad = moving()
        bad[1] = mesh_of(*grid(5))
        filter = simple.RegionsofInterest(Input=self.series_of("bad", bad), K=3)
        with Messages():
            at(filter, 0)
        filter.Input = self.series_of("right", moving())
        self.assertEqual(at(filter, 0).GetNumberOfPoints(), 36)

    def test_polygons_come_out_as_they_went_in_beside_cells_of_other_kinds(self):
        meshes = moving()
        for mesh in meshes:
            vertices, lines = vtkCellArray(), vtkCellArray()
            vertices.InsertNextCell(1, [3])
            lines.InsertNextCell(2, [0, 7])
            mesh.SetVerts(vertices)
            mesh.SetLines(lines)
        found = at(simple.RegionsofInterest(Input=self.series_of("mixed", meshes), K=2), 1)
        self.assertEqual(found.GetNumberOfCells(), 27)
        self.assertEqual(list(polygons(found)[1]), [v for quad in grid()[1] for v in quad])
        in_l = cell_array(found, "in_L")
        roi = point_array(found, "roi")
        self.assertEqual(list(in_l[:2]), [0, 0])
        self.assertEqual(list(in_l[2:]), [int(roi[quad].any()) for quad in grid()[1]])


if __name__ == "__main__":
    run_tests()
