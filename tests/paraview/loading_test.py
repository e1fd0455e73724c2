"""The plugin's sources and filters are the operations of the table."""

import unittest

from paraview import servermanager

from host import *

FILTERS = {"regions": "RegionsofInterest", "decompose": "SparseComponents",
           "transfer": "RegionTransfer", "geodesic": "GeodesicDistance", "info": "mimetraInfo",
           "check": "mimetraCheck", "align": "mimetraAlign", "evaluate": "mimetraEvaluate",
           "simplify": "mimetraSimplify", "subdivide": "mimetraSubdivide"}
# ParaView saves what it shows itself, and draws it; markers are a file that people edit.
LEFT_OUT = {"convert", "render", "markers"}
# What a pipeline knows by itself, and what only files take.
OF_FILES = {"weights", "weight-scale", "topology", "frames", "fps", "compress", "format", "double",
            "single"}


class Plugin(HostTest):
    @classmethod
    def setUpClass(cls):
        cls.operations = {operation["name"]: operation
                          for operation in json.loads(mimetra("operations", "--json"))["operations"]}

    @classmethod
    def tearDownClass(cls):
        pass

    def test_is_loaded_with_its_sources_and_filters(self):
        for name in [*FILTERS.values(), "mimetraSequence"]:
            self.assertTrue(hasattr(simple, name), name)

    def test_has_a_filter_for_every_operation_that_begins_with_a_mesh(self):
        first = {name: next((each for each in operation.get("inputs", []) if not each["optional"]),
                            {"kind": None}) for name, operation in self.operations.items()}
        self.assertEqual({name for name, each in first.items()
                          if each["kind"] == "sequence"}, {*FILTERS} | LEFT_OUT)

    def test_has_every_parameter_with_its_default_its_range_and_its_help(self):
        for operation, name in FILTERS.items():
            proxy = getattr(simple, name)(Input=simple.Sphere())
            for parameter in self.operations[operation]["parameters"]:
                if parameter["name"] in OF_FILES:
                    continue
                with self.subTest(operation=operation, parameter=parameter["name"]):
                    self.assert_property(proxy.SMProxy.GetProperty(parameter["name"]), parameter)

    def assert_property(self, held, parameter):
        default = parameter["default"]
        if default is None:
            default = ""
        if isinstance(default, list):
            default = ",".join(map(str, default))
        self.assertEqual(held.GetElement(0), default)
        self.assertIn(parameter["help"], held.GetDocumentation().GetDescription())
        for bound in ["minimum", "maximum"]:
            if bound in parameter and not isinstance(held.GetElement(0), str):
                domain = held.FindDomain("vtkSMDoubleRangeDomain") or held.FindDomain(
                    "vtkSMIntRangeDomain")
                self.assertEqual(getattr(domain, f"Get{bound.capitalize()}")(0), parameter[bound])
        if parameter["kind"] == "choice":
            domain = held.FindDomain("vtkSMStringListDomain")
            self.assertEqual([domain.GetString(i) for i in range(domain.GetNumberOfStrings())],
                             parameter["choices"])

    def test_comes_back_from_a_state_file(self):
        simple.RegionsofInterest(Input=simple.Sphere(), K=7, Radius="12abs", Signed=1)
        with tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state.pvsm")
            servermanager.SaveState(state)
            simple.ResetSession()
            servermanager.LoadState(state)
        [proxy] = [source for (name, _), source in simple.GetSources().items()
                   if name.startswith("RegionsofInterest")]
        self.assertEqual((proxy.K, proxy.Radius, proxy.Signed), (7, "12abs", 1))

    def test_shows_few_parameters_at_once(self):
        proxy = simple.RegionsofInterest(Input=simple.Sphere()).SMProxy
        shown = {name for name in ["k", "radius", "coverage", "rho", "iterations", "components"]
                 if proxy.GetProperty(name).GetPanelVisibility() == "default"}
        self.assertEqual(shown, {"k", "radius", "coverage"})
        proxy = simple.mimetraEvaluate(Input=simple.Sphere()).SMProxy
        shown = {name for name in ["target", "k", "radius", "coverage", "rho", "space"]
                 if proxy.GetProperty(name).GetPanelVisibility() == "default"}
        self.assertEqual(shown, {"target", "k", "radius", "coverage"})


if __name__ == "__main__":
    run_tests()
