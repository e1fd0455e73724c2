"""300 frames of 6706 vertices play after one decomposition; prints what a time step costs."""

import statistics
import time
import unittest

from host import *

FRAMES_PLAYED = 300


class Playing(HostTest):
    @classmethod
    def setUpClass(cls):
        """A cylinder of 6706 vertices with waves that run along it."""
        cls.folder = tempfile.TemporaryDirectory(prefix="mimetra_paraview_")
        path = pathlib.Path(cls.folder.name)
        rows, columns = 479, 14
        angle, height = np.meshgrid(np.arange(columns) * 2 * np.pi / columns,
                                    np.linspace(0, 40, rows))
        ring = np.stack([np.cos(angle), np.sin(angle), height], axis=2).reshape(-1, 3)
        cls.count = len(ring)
        first = np.arange((rows - 1) * columns).reshape(rows - 1, columns)
        following = np.roll(first, -1, axis=1)
        quads = np.stack([first, following, following + columns, first + columns], axis=2)
        with open(path / "take.topology.ply", "w") as file:
            file.write(f"ply\nformat ascii 1.0\nelement vertex {len(ring)}\nproperty float x\n"
                       "property float y\nproperty float z\nelement face "
                       f"{quads.size // 4}\nproperty list uchar int vertex_indices\nend_header\n")
            np.savetxt(file, ring, fmt="%.9g")
            np.savetxt(file, np.insert(quads.reshape(-1, 4), 0, 4, axis=1), fmt="%d")
        times = np.linspace(0, 2 * np.pi, FRAMES_PLAYED)
        wave = 1 + 0.2 * np.sin(times[:, None] - ring[None, :, 2])
        frames = np.repeat(ring[None], FRAMES_PLAYED, axis=0)
        frames[:, :, :2] *= wave[:, :, None]
        np.save(path / "take.npy", frames)
        cls.take = path / "take.npy"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def seconds_per_step(self, proxy, times):
        """Median, so that what else the machine does hardly counts."""
        proxy.UpdatePipeline(times[-1])
        taken = []
        for step in times:
            begin = time.perf_counter()
            proxy.UpdatePipeline(step)
            taken.append(time.perf_counter() - begin)
        return statistics.median(taken)

    def test_region_transfer(self):
        self.assertEqual(self.count, 6706)
        source = simple.mimetraSequence(FileName=str(self.take))
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues)
        self.assertEqual(len(times), FRAMES_PLAYED)
        target = simple.mimetraSequence(FileName=str(self.take), Frames="0:1")
        filter = simple.RegionTransfer(Input=source, Target=target, K=10)
        alone = self.seconds_per_step(source, times)
        begin = time.perf_counter()
        filter.UpdatePipeline(0)
        computed = time.perf_counter() - begin
        played = self.seconds_per_step(filter, times)
        print(f"\ncomputed in {computed:.2f} s; per time step {1000 * alone:.2f} ms without and "
              f"{1000 * played:.2f} ms with Region Transfer", flush=True)
        self.assertEqual(decompositions(filter), 1)


if __name__ == "__main__":
    run_tests()
