#include <cmath>
#include <functional>
#include <sstream>

#include <dlib/image_processing/shape_predictor.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

/// The parts of a shape predictor as dlib stores them; one cascade with one tree.
struct StoredModel {
  dlib::matrix<float, 0, 1> mean = dlib::zeros_matrix<float>(136, 1);
  std::vector<std::vector<dlib::impl::regression_tree>> forests{1, {1, tree()}};
  std::vector<std::vector<unsigned long>> anchors{{0, 67}};
  std::vector<std::vector<dlib::vector<float, 2>>> offsets{{{0, 0}, {1, 1}}};

  static dlib::impl::regression_tree tree() {
    dlib::impl::regression_tree tree;
    tree.splits.push_back({0, 1, 0.5F});
    tree.leaf_values.assign(2, dlib::zeros_matrix<float>(136, 1));
    return tree;
  }

  std::string bytes() const {
    std::ostringstream file;
    dlib::serialize(1, file);
    dlib::serialize(mean, file);
    dlib::serialize(forests, file);
    dlib::serialize(anchors, file);
    dlib::serialize(offsets, file);
    return file.str();
  }
};

class StoredFaceModel : public testing::Test {
 protected:
  void write(const StoredModel& model) { write_bytes(path(), model.bytes()); }
  std::string refusal_of(const std::function<void(StoredModel&)>& change) {
    StoredModel model;
    change(model);
    write(model);
    return test::message_of<IoError>([&] { FaceFinder{path()}; });
  }
  std::filesystem::path path() { return folder_ / "model.dat"; }
  test::TemporaryFolder folder_;
};

TEST_F(StoredFaceModel, ThatIsWholeIsTaken) {
  write({});
  EXPECT_NO_THROW(FaceFinder{path()});
}

/// dlib would read and write where nothing is.
TEST_F(StoredFaceModel, WhoseNumbersPointNowhereIsRefused) {
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.anchors[0][0] = 68; }), HasSubstr("no landmark"));
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.forests[0][0].splits[0].idx2 = 2; }),
              HasSubstr("compares what is not there"));
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.forests[0][0].leaf_values.pop_back(); }),
              HasSubstr("a leaf more"));
  EXPECT_THAT(refusal_of([](StoredModel& m) {
                m.forests[0][0].leaf_values[1] = dlib::zeros_matrix<float>(4, 1);
              }),
              HasSubstr("68 landmarks"));
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.offsets[0].pop_back(); }),
              HasSubstr("compares what is not there"));
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.anchors.clear(); }), HasSubstr("anchors"));
  EXPECT_THAT(refusal_of([](StoredModel& m) { m.mean = dlib::zeros_matrix<float>(10, 1); }),
              HasSubstr("68 landmarks"));
}

TEST_F(StoredFaceModel, ThatClaimsMoreThanItsBytesIsRefused) {
  std::ostringstream file;
  dlib::serialize(1, file);
  dlib::serialize(StoredModel().mean, file);
  dlib::serialize(2'000'000'000UL, file);
  write_bytes(path(), file.str());
  EXPECT_THAT(test::message_of<IoError>([&] { FaceFinder{path()}; }),
              HasSubstr("counts 2000000000 entries"));
}

TEST_F(StoredFaceModel, TruncatedAnywhereIsRefused) {
  const std::string bytes = StoredModel().bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    write_bytes(path(), bytes.substr(0, size));
    EXPECT_THROW(FaceFinder{path()}, IoError) << size;
  }
}

}  // namespace
}  // namespace mimetra
