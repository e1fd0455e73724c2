"""Sparse Components: a block for each component at weight 1, and the table of weights."""

import csv
import unittest

from host import *


class SparseComponents(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.csv = cls.sample / "weights.csv"
        mimetra("decompose", cls.sample.take, "-k", 6, "-o", cls.sample / "c.h5", "--weights-out",
                cls.csv)
        cls.pvd = cls.sample / "regions.pvd"
        cls.report = json.loads(mimetra("regions", cls.sample.take, "-k", 6, "--component-fields",
                                        "-o", cls.pvd, "--json"))

    def filter(self):
        source = simple.mimetraSequence(FileName=str(self.sample.take))
        return simple.SparseComponents(Input=source, K=6, SideBySide=0)

    def test_shows_the_components_of_the_command(self):
        blocks = at(self.filter(), 0)
        expected = at(simple.PVDReader(FileName=str(self.pvd)), 0)
        self.assertEqual(blocks.GetNumberOfBlocks(), 6)
        self.assertGreater(len(self.report["regions"]), 3)
        for number, region in enumerate(self.report["regions"]):
            block = blocks.GetBlock(region["component"])
            self.assert_same(point_array(block, "displacement"),
                             point_array(expected, f"component_{number}"))
            self.assert_same(point_array(block, "support"),
                             point_array(expected, f"support_{number}"))

    def test_moves_each_block_by_its_component_from_the_rest_pose(self):
        rest = np.load(self.sample.take)[0]
        blocks = at(self.filter(), 1)
        for k in range(6):
            block = blocks.GetBlock(k)
            moved = point_array(block, "displacement").astype(float)
            # Displacements are shown in single precision.
            np.testing.assert_allclose(points(block) - rest, moved, rtol=1e-6, atol=1e-12)

    def test_stands_side_by_side(self):
        filter = self.filter()
        together = at(filter, 0)
        filter.SideBySide = 1
        apart = at(filter, 0)
        self.assertEqual(decompositions(filter), 1)
        boxes = []
        for k in range(6):
            # The same mesh elsewhere, to the rounding of single precision.
            way = points(apart.GetBlock(k)) - points(together.GetBlock(k))
            size = np.abs(points(apart.GetBlock(k))).max()
            np.testing.assert_allclose(way, np.broadcast_to(way[0], way.shape), atol=1e-6 * size)
            boxes.append((points(apart.GetBlock(k)).min(0), points(apart.GetBlock(k)).max(0)))
        for k, (low, high) in enumerate(boxes):
            for other_low, other_high in boxes[:k]:
                self.assertTrue((low > other_high).any() or (other_low > high).any())

    def test_has_the_weights_of_the_command_under_the_names_of_the_blocks(self):
        filter = self.filter()
        table = at(filter, port=1)
        blocks = at(filter, 0)
        names = [blocks.GetMetaData(k).Get(blocks.NAME()) for k in range(6)]
        with open(self.csv, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["time"] + names)
        self.assertEqual([table.GetColumnName(i) for i in range(7)], ["Time"] + names)
        self.assert_table(table, rows)

    def test_decomposes_once_for_both_outputs_and_all_times(self):
        filter = self.filter()
        for time in [0, 1, 2]:
            at(filter, time)
            at(filter, port=1)
        self.assertEqual(decompositions(filter), 1)

    def test_keeps_the_points_and_polygons_of_the_input(self):
        given = at(simple.mimetraSequence(FileName=str(self.sample.take)), 0)
        block = at(self.filter(), 0).GetBlock(0)
        for mine, its in zip(polygons(block), polygons(given)):
            self.assert_same(mine, its)


if __name__ == "__main__":
    run_tests()
