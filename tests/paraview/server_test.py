"""A client of a server of two processes: the fields of the command, and refusals said once."""

import re
import socket
import time
import unittest

from paraview import servermanager

from host import *

SECONDS_TO_START = 60


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class Server:
    """pvserver on two processes, and this client connected to it."""

    def __init__(self, folder):
        self.log = folder / "server.log"
        port = free_port()
        with open(self.log, "w") as log:
            self.process = subprocess.Popen(
                [os.environ["MPIRUN"], "-n", "2", "--oversubscribe", "--allow-run-as-root",
                 os.environ["PVSERVER"], f"--server-port={port}"], stdout=log,
                stderr=subprocess.STDOUT,
                env=environment_of_its_own())
        end = time.monotonic() + SECONDS_TO_START
        while "Accepting connection" not in self.log.read_text():
            if time.monotonic() > end or self.process.poll() is not None:
                self.end()
                raise RuntimeError(self.log.read_text())
            time.sleep(0.1)
        simple.Connect("localhost", port)

    def errors(self):
        return re.findall(r"ERR\|.*", self.log.read_text())

    def close(self):
        simple.Disconnect()
        self.end()

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=SECONDS_TO_START)


def fetched(proxy, time=0):
    proxy.UpdatePipeline(time)
    return servermanager.Fetch(proxy)


class OfTwoProcesses(HostTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server = Server(cls.sample.path)

    @classmethod
    def tearDownClass(cls):
        cls.server.close()
        super().tearDownClass()

    def distributed(self, numbered=True):
        take = simple.mimetraSequence(FileName=str(self.sample.take))
        source = simple.GenerateGlobalIds(Input=take) if numbered else take
        return simple.ExtractSurface(Input=simple.RedistributeDataSet(Input=source))

    def test_shows_the_distances_of_the_command(self):
        before = len(self.server.errors())
        vtp = self.sample / "distance.vtp"
        mimetra("geodesic", self.sample.take, "--frames", "0:1", "--source", 100, "-o", vtp)
        expected = point_array(fetched(simple.XMLPolyDataReader(FileName=[str(vtp)])), "distance")
        found = fetched(simple.GeodesicDistance(Input=self.distributed(), Source="100"))
        ids = point_array(found, "GlobalPointIds")
        self.assertEqual(set(ids), set(range(len(expected))))
        self.assertGreater(len(ids), len(expected))  # seams are on both processes
        self.assert_same(point_array(found, "distance"), expected[ids])
        self.assertEqual(len(self.server.errors()), before)

    def test_shows_the_regions_of_one_process_over_time(self):
        take = simple.mimetraSequence(FileName=str(self.sample.take))
        alone = simple.RegionsofInterest(Input=take, K=5)
        shared = simple.RegionsofInterest(Input=self.distributed(), K=5)
        for step in [0, 3, 1]:
            expected, found = fetched(alone, step), fetched(shared, step)
            ids = point_array(found, "GlobalPointIds")
            for name in ["roi", "displacement"]:
                self.assert_same(point_array(found, name), point_array(expected, name)[ids])
        self.assertEqual(decompositions(shared), 1)

    def test_says_once_what_is_refused(self):
        before = len(self.server.errors())
        filter = simple.GeodesicDistance(Input=self.distributed(numbered=False))
        self.assertEqual(fetched(filter).GetNumberOfPoints(), 0)
        said = self.server.errors()[before:]
        self.assertEqual(len(said), 1, said)
        self.assertIn("process 0 has a piece of the mesh without global ids; apply the filter "
                      "Generate Global Ids", said[0])


if __name__ == "__main__":
    run_tests()
