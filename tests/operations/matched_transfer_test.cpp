// What a transfer over a correspondence hands to hosts and to files beside its frames.

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/transfer/faces.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class MatchedTransferTest : public testing::Test {
 protected:
  MatchedTransferTest() {
    add_toolkit(table_);
    const auto faces = test::connectivity_of(test::patch());
    std::ofstream(folder_ / "pairs.json")
        << correspondence_json(Correspondence::identity(128), *faces, *faces);
  }

  /// Of a patch to itself; `paths` are those that are asked for.
  NamedData transferred(const std::vector<std::filesystem::path>& paths) const {
    const Operation& operation = *table_.find("transfer");
    Invocation call;
    call.inputs["source"] = {{"take", FieldSequence(test::shaken(test::patch(), 3, 0.1)), {}}};
    call.inputs["target"] = {
        {"actor", ModelData{MorphableModel(test::model_on(test::bent_patch(), 3))}, {}}};
    call.parameters = Parameters(operation.parameters);
    call.parameters.set("full", true);
    call.parameters.set("correspondence", (folder_ / "pairs.json").string());
    call.wanted["out"] = paths;
    return operation.run(call).outputs.at("out").front();
  }

  static std::vector<std::string> names_of(const std::vector<Field>& fields) {
    std::vector<std::string> names;
    names.reserve(fields.size());
    for (const Field& field : fields) names.push_back(field.name);
    return names;
  }

  test::TemporaryFolder folder_;
  OperationTable table_;
};

TEST_F(MatchedTransferTest, HasFieldsForAHostThatShowsThem) {
  const NamedData out = transferred({});
  EXPECT_THAT(names_of(std::get<FieldSequence>(out.data).fields),
              ElementsAre("match_residual", "match_partners"));
  EXPECT_THAT(out.more_fields, IsEmpty());
}

TEST_F(MatchedTransferTest, WritesTheCorrespondenceBesideAFileAndFieldsWhereItHoldsThem) {
  const NamedData out = transferred({folder_ / "x.npy"});
  EXPECT_THAT(std::get<FieldSequence>(out.data).fields, IsEmpty());
  EXPECT_THAT(names_of(out.more_fields), ElementsAre("match_residual", "match_partners"));
  EXPECT_EQ(out.beside.count(".correspondence.json"), 1u);
}

}  // namespace
}  // namespace mimetra
