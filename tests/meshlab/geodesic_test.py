"""Geodesic Support Map: the fields of `mimetra geodesic` as vertex quality."""

import unittest

from host import *


class GeodesicSupportMap(HostTest):
    def expected(self, field, *options):
        out = self.path / "geodesic.vtp"
        mimetra("geodesic", self.target, "-o", out, "--force", *options)
        return Fields(out).on_vertices(field).astype("f4")

    def quality(self, *filters):
        [layer] = self.apply([self.target], filters, [("quality.ply", 0, "vq vf")])
        return layer.vertices["quality"]

    def test_is_the_support_of_a_vertex(self):
        found = self.quality(filter_script("Geodesic Support Map", source="1200"))
        self.assert_same(found, self.expected("support", "--source", 1200))
        self.assertEqual((found.min(), found.max()), (0, 1))

    def test_is_the_distance_where_asked(self):
        found = self.quality(filter_script("Geodesic Support Map", source="17,1200", quality=1,
                                           geodesics=1))
        expected = self.expected("distance", "--source", "17,1200", "--geodesics", "heat-direct")
        self.assertTrue(np.isnan(expected).any())
        self.assert_same(found, np.where(np.isnan(expected), np.float32(-1), expected))

    def test_starts_at_the_selected_vertices(self):
        select = filter_script("Conditional Vertex Selection", condSelect="(vi==17)||(vi==1200)")
        found = self.quality(select, filter_script("Geodesic Support Map", d_max="60abs"))
        self.assert_same(found, self.expected("support", "--source", "17,1200", "--d-max", "60abs"))

    def test_keeps_the_selection(self):
        select = filter_script("Conditional Vertex Selection", condSelect="vi==1200")
        [layer] = self.apply([self.target], [select, filter_script("Geodesic Support Map")],
                             [("selected.ply", 0, "vf")])
        self.assertEqual(list(np.flatnonzero(layer.vertices["flags"] & SELECTED)), [1200])

    def test_measures_a_layer_as_its_matrix_places_it(self):
        project = self.path / "twice.mlp"
        project.write_text(
            f'<!DOCTYPE MeshLabDocument><MeshLabProject><MeshGroup><MLMesh label="twice" '
            f'filename="{self.target}"><MLMatrix44>2 0 0 5 0 2 0 0 0 0 2 0 0 0 0 1</MLMatrix44>'
            f'</MLMesh></MeshGroup></MeshLabProject>')
        script = self.script_of([filter_script("Geodesic Support Map", source="1200",
                                               d_max="120abs")])
        out = self.path / "twice.ply"
        done = self.meshlab.run("-p", project, "-s", script, "-o", out, "-m", "vq")
        self.assertEqual(done.returncode, 0, done.stdout)
        expected = self.expected("support", "--source", 1200, "--d-max", "60abs")
        np.testing.assert_allclose(Ply(out).vertices["quality"], expected, atol=1e-6)

    def test_asks_for_a_source(self):
        self.assert_refused([self.target], [filter_script("Geodesic Support Map")],
                            "layer 'target.ply' has no selected vertices; select some, or name "
                            "them as the source")


if __name__ == "__main__":
    unittest.main()
