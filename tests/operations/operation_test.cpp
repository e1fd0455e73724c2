#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/call.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const OperationTable& toolkit() {
  static const OperationTable table = [] {
    OperationTable made;
    add_toolkit(made);
    return made;
  }();
  return table;
}

/// A flat grid whose middle rises and falls.
MeshSequence waving_grid() {
  const test::Shape shape = test::grid(7, 7);
  Frames frames(6, shape.positions.size());
  for (int f = 0; f < 6; ++f) {
    Positions pose = shape.positions;
    pose(24, 2) += std::sin(f);
    pose(10, 2) += std::cos(2.0 * f) - 1;
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return MeshSequence(Connectivity::from_triangles(49, shape.triangles), frames, {},
                      shape.positions);
}

Invocation invocation_of(const OperationTable& table, const std::string& name) {
  Invocation invocation;
  invocation.parameters = Parameters(table.parameters_of(*table.find(name)));
  return invocation;
}

TEST(OperationTable, RefusesANameThatIsTaken) {
  OperationTable table = toolkit();
  EXPECT_THROW(table.add(*table.find("info")), std::invalid_argument);
}

TEST(OperationTable, RefusesAParameterThatMeansTwoThings) {
  OperationTable table = toolkit();
  Format format;
  format.kind = DataKind::components;
  format.extensions = {".x"};
  format.writing = {{"rho", ParameterKind::text, {}, "another rho"}};
  format.write = [](const Data&, const std::filesystem::path&, const WriteOptions&,
                    const Context&) { return Format::Paths(); };
  EXPECT_THAT([&] { table.add(format); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("'rho' means two things")));
}

TEST(OperationTable, RefusesANameThatTwoOfAnOperationHave) {
  OperationTable table = toolkit();
  Operation operation;
  operation.name = "mine";
  operation.inputs = {{"sequence", DataKind::sequence, "a mesh"}};
  operation.outputs = {{"weights", DataKind::table, "as --weights of reading"}};
  EXPECT_THAT([&] { table.add(operation); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("'weights' is there twice")));
  operation.outputs = {{"out", DataKind::sequence, "a copy"}};
  operation.parameters = {{"fps", ParameterKind::number, {}, "of the same kind as of reading"}};
  EXPECT_THAT([&] { table.add(operation); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("'fps' means two things")));
  operation.parameters = {{"speed", ParameterKind::number, {}, "its own"}};
  EXPECT_NO_THROW(table.add(operation));
}

TEST(Table, QuotesNamesThatHoldACommaOrAQuotationMark) {
  EXPECT_EQ((Table{{"speed, mm/s", "5\""}, {{1.5, std::nullopt}}}.csv()),
            "\"speed, mm/s\",\"5\"\"\"\n1.5,\n");
}

TEST(OperationTable, EveryOperationHasTwoExamplesThatStartWithItsName) {
  const OperationTable& table = toolkit();
  for (const Operation& operation : table.operations()) {
    EXPECT_EQ(operation.examples.size(), 2u) << operation.name;
    for (const std::string& example : operation.examples) {
      EXPECT_TRUE(example.starts_with(operation.name)) << example;
    }
  }
}

TEST(OperationTable, EveryDefaultIsAValueTheParameterAccepts) {
  const OperationTable& table = toolkit();
  for (const Operation& operation : table.operations()) {
    for (const Parameter& parameter : table.parameters_of(operation)) {
      if (std::holds_alternative<std::monostate>(parameter.fallback)) continue;
      EXPECT_NO_THROW(check_value(parameter, parameter.fallback))
          << operation.name << ' ' << parameter.name;
    }
  }
}

TEST(OperationTable, ListsItselfAsJson) {
  OperationTable table = toolkit();
  add_listing(table);
  const Outcome outcome = table.find("operations")->run(invocation_of(table, "operations"));
  const json report = json::parse(outcome.report);
  std::set<std::string> names;
  for (const json& entry : report.at("operations")) {
    names.insert(entry.at("name").get<std::string>());
  }
  EXPECT_EQ(names.size(), table.operations().size());
  EXPECT_TRUE(names.contains("transfer"));
}

TEST(OutputPaths, GiveEachOfSeveralTargetsItsOwn) {
  using Paths = std::vector<std::filesystem::path>;
  const OperationTable& table = toolkit();
  const Output output{"out", DataKind::sequence, "", false, true};
  EXPECT_EQ(table.output_paths(output, "T/", {"b"}), Paths{"T/"});
  EXPECT_EQ(table.output_paths(output, "T", {"a", "b"}), (Paths{"T/a", "T/b"}));
  EXPECT_EQ(table.output_paths(output, "results.v2/", {"a", "b@x=0.5"}),
            (Paths{"results.v2/a", "results.v2/b@x=0.5"}));
  EXPECT_EQ(table.output_paths(output, "d/T.npy", {"a", "b"}), (Paths{"d/T-a.npy", "d/T-b.npy"}));
}

TEST(OutputNames, AreWhatTheirExtensionsSay) {
  const OperationTable& table = toolkit();
  const Output sequence{"out", DataKind::sequence, ""};
  for (const char* folder : {"take", "take/", "take.v2/", "a.b/take", ".hidden"}) {
    EXPECT_TRUE(table.writes_folder(sequence, folder)) << folder;
  }
  for (const char* unknown : {"take.fbx", "take.abc", "take.usd", "take.mp4", "take.v2"}) {
    EXPECT_THAT(
        [&] { table.writer(sequence, unknown); },
        testing::ThrowsMessage<UsageError>(testing::AllOf(
            testing::HasSubstr(".npy, .npz, .pc2"), testing::HasSubstr("or a folder, not as"),
            testing::HasSubstr("; a folder of this name is '" + std::string(unknown) + "/'"))))
        << unknown;
  }
}

TEST(OutputPaths, PutACompanionBesideTheMainOutput) {
  const OperationTable& table = toolkit();
  Operation operation;
  operation.outputs = {{"out", DataKind::sequence, ""},
                       {"fit-out", DataKind::fit, "", true, false, ".fit.json"}};
  const auto path = [&](const char* out) {
    return table.companion_path(operation, operation.outputs.back(), out);
  };
  EXPECT_EQ(path("take"), "take.fit.json");
  EXPECT_EQ(path("d/take.v2/"), "d/take.v2.fit.json");
  EXPECT_EQ(path("d/take.npy"), "d/take.fit.json");
  EXPECT_EQ(path("./one.obj"), "one.fit.json");
}

/// The waving grid onto itself, by two regions.
Invocation transfer_of_the_grid(const OperationTable& table) {
  const MeshSequence source = waving_grid();
  Invocation invocation = invocation_of(table, "transfer");
  invocation.parameters.set("k", std::int64_t{2});
  invocation.inputs["source"] = {{"source", FieldSequence(source), {.model_driven = true}}};
  ShapeBasis none{{}, Eigen::MatrixXd(source.vertices() * 3, 0)};
  invocation.inputs["target"] = {
      {"target", ModelData{MorphableModel(
                     BlendshapeModel(source.shared_connectivity(), source.rest(), none))}}};
  return invocation;
}

TEST(Operations, RunOnValuesWithoutFiles) {
  const OperationTable& table = toolkit();
  const MeshSequence source = waving_grid();
  Invocation invocation = transfer_of_the_grid(table);
  invocation.parameters.set("falloff", std::string("1e-9abs"));  // a hard border
  const Outcome outcome = table.find("transfer")->run(invocation);
  const MeshSequence& result =
      std::get<FieldSequence>(outcome.outputs.at("out").front().data).sequence();
  // The same mesh as target: the source's deformation inside the regions is the target's.
  EXPECT_LT((result.positions() - source.positions()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Operations, StartFromTheComponentsOfAnEarlierRunAndGiveTheSame) {
  const OperationTable& table = toolkit();
  Invocation transfer = transfer_of_the_grid(table);
  Invocation regions = invocation_of(table, "regions");
  regions.parameters.set("k", std::int64_t{2});
  regions.inputs["sequence"] = transfer.inputs["source"];
  for (auto& [name, invocation] :
       {std::pair("transfer", transfer), std::pair("regions", regions)}) {
    Invocation call = invocation;
    call.wanted["components-out"] = {};
    Outcome first = table.find(name)->run(call);
    call.inputs["components"] = first.outputs.at("components-out");
    const Outcome again = table.find(name)->run(call);
    const auto positions = [](const Outcome& outcome) {
      const Data& data = outcome.outputs.at("out").front().data;
      const auto* shown = std::get_if<FieldSequence>(&data);
      return shown ? shown->sequence().positions()
                   : Frames(std::get<RegionData>(data).fields.fields.front().values.transpose());
    };
    EXPECT_TRUE(positions(again) == positions(first)) << name;
  }
}

TEST(Operations, ReadARegionSetForASequenceThatTheCallerHas) {
  const OperationTable& table = toolkit();
  const test::TemporaryFolder folder;
  std::ofstream(folder / "list.txt") << "24\n25\n";
  const Invocation call = transfer_of_the_grid(table);
  const LoadedInputs loaded =
      load_inputs(table, *table.find("transfer"), call.parameters,
                  {{"regions", {(folder / "list.txt").string()}}}, {}, call.inputs);
  EXPECT_EQ(loaded.data.at("source").front().name, "source");
  const auto& regions = std::get<RegionData>(loaded.data.at("regions").front().data).regions;
  EXPECT_EQ(regions.vertices, 49);
  EXPECT_EQ(regions.vertex_count(), 2);
}

TEST(Operations, DecomposeTellsTheWeightsOverTime) {
  const OperationTable& table = toolkit();
  Invocation invocation = invocation_of(table, "decompose");
  invocation.parameters.set("k", std::int64_t{2});
  const MeshSequence sequence = waving_grid();
  invocation.inputs["sequence"] = {{"take", FieldSequence(sequence), {.model_driven = true}}};
  EXPECT_FALSE(table.find("decompose")->run(invocation).outputs.contains("weights-out"));
  invocation.wanted["weights-out"] = {};
  const Outcome outcome = table.find("decompose")->run(invocation);
  const auto& components = std::get<Components>(outcome.outputs.at("out").front().data);
  const auto& weights = std::get<Table>(outcome.outputs.at("weights-out").front().data);
  EXPECT_THAT(weights.columns, testing::ElementsAre("time", "component_0", "component_1"));
  ASSERT_EQ(weights.rows.size(), 6u);
  for (int f = 0; f < 6; ++f) {
    const auto& row = weights.rows[static_cast<std::size_t>(f)];
    EXPECT_EQ(row[0], sequence.times()[f]);
    EXPECT_EQ(row[1], components.weights(f, 0));
    EXPECT_EQ(row[2], components.weights(f, 1));
  }
}

TEST(Operations, RefuseATargetWithOtherFaces) {
  const OperationTable& table = toolkit();
  const MeshSequence source = waving_grid();
  Triangles others = source.triangles();
  others(5, 0) = others(9, 2);
  ShapeBasis none{{}, Eigen::MatrixXd(source.vertices() * 3, 0)};
  Invocation invocation = invocation_of(table, "transfer");
  invocation.inputs["source"].push_back({"source", FieldSequence(source), {.model_driven = true}});
  invocation.inputs["target"].push_back(
      {"other",
       ModelData{MorphableModel(BlendshapeModel(
           std::make_shared<Connectivity>(Connectivity::from_triangles(source.vertices(), others)),
           source.rest(), none))}});
  EXPECT_THAT([&] { table.find("transfer")->run(invocation); },
              testing::ThrowsMessage<MismatchError>(HasSubstr("other: face 5")));
}

TEST(Operations, EvaluateNeverBeatsTheFullTransferOverAllTriangles) {
  const OperationTable& table = toolkit();
  const MeshSequence source = waving_grid();
  Eigen::MatrixXd basis(source.vertices() * 3, 2);
  basis.setZero();
  basis(24 * 3 + 2, 0) = 1;
  basis(10 * 3 + 2, 1) = -2;
  Invocation invocation = invocation_of(table, "evaluate");
  invocation.parameters.set("k", std::vector<std::int64_t>{1, 2});
  invocation.inputs["source"].push_back({"source", FieldSequence(source), {.model_driven = true}});
  invocation.inputs["target"].push_back({"target", ModelData{MorphableModel(BlendshapeModel(
                                                       source.shared_connectivity(), source.rest(),
                                                       ShapeBasis{{"up", "down"}, basis}))}});
  const json rows = json::parse(table.find("evaluate")->run(invocation).report).at("rows");
  ASSERT_EQ(rows.size(), 3u);
  const double full = rows[2].at("de_all");
  EXPECT_TRUE(rows[2].at("k").is_null());
  for (const json& row : rows) {
    EXPECT_GE(row.at("de_all").get<double>(), full * (1 - 1e-12));
    if (row.at("k").is_null()) continue;
    EXPECT_LE(row.at("mpe_all").get<double>(), 1e-9);
  }
}

}  // namespace
}  // namespace mimetra
