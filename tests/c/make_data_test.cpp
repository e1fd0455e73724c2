// Values made of arrays, and of other values.

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugins/c/make_data.h"
#include "plugins/c/value.h"
#include "tests/shapes.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::ThrowsMessage;

mimetra_array array(const char* name, int type, std::initializer_list<std::int64_t> shape,
                    const void* values, int location = MIMETRA_NOWHERE) {
  mimetra_array made{sizeof made, type,  static_cast<std::int32_t>(shape.size()), location, {},
                     name,        values};
  std::ranges::copy(shape, made.shape);
  return made;
}

/// A list as the interface takes it.
std::vector<const mimetra_array*> list_of(const std::vector<mimetra_array>& arrays) {
  std::vector<const mimetra_array*> list;
  list.reserve(arrays.size() + 1);
  for (const mimetra_array& each : arrays) list.push_back(&each);
  list.push_back(nullptr);
  return list;
}

NamedData made(mimetra_kind kind, const std::vector<mimetra_array>& arrays) {
  return made_data(kind, "it", list_of(arrays).data());
}

NamedData derived(const NamedData& base, const std::vector<mimetra_array>& changes) {
  return derived_data(base, list_of(changes).data());
}

template <typename Value>
Value derived(const Value& base, const std::vector<mimetra_array>& changes) {
  return std::get<Value>(derived(NamedData{"it", base}, changes).data);
}

MeshSequence moving_take() {
  const test::Shape shape = test::grid(3, 2);
  Frames frames(2, shape.positions.size());
  frames.row(0) = shape.positions.reshaped<Eigen::RowMajor>();
  frames.row(1) = 2 * frames.row(0);
  const int vertices = static_cast<int>(shape.positions.rows());
  return {Connectivity::from_triangles(vertices, shape.triangles), frames};
}

constexpr int kVertices = 6;  // of that take
constexpr int kTriangles = 4;

Components components() {
  Components made;
  const MeshSequence sequence = moving_take();
  made.rest = sequence.frame(0);
  made.triangles = sequence.triangles();
  made.displacements = Frames::Ones(1, 3 * kVertices);
  made.centers = {0};
  made.options.sparsity = 7;
  return made;
}

TEST(DerivedData, KeepsWhatNoArrayShows) {
  const MeshSequence sequence = moving_take();
  const double times[] = {1, 2};
  const std::vector<mimetra_array> other_times = {array("times", MIMETRA_F64, {2}, times)};
  const FieldSequence moving(sequence, {}, true);
  const NamedData driven{"it", moving, {.model_driven = true}};
  EXPECT_TRUE(derived(driven, other_times).origin.model_driven);
  EXPECT_TRUE(derived(moving, other_times).displacement);
  EXPECT_EQ(derived(moving, other_times).sequence().times()[1], 2);

  const double scale[] = {3};
  const Components scaled = derived(components(), {array("scale", MIMETRA_F64, {1}, scale)});
  EXPECT_EQ(scaled.scale, 3);
  EXPECT_EQ(scaled.options.sparsity, 7);

  const Positions moved = 2 * sequence.frame(0);
  const ShapeBasis none{{}, Eigen::MatrixXd(3 * kVertices, 0)};
  const ModelData model{
      MorphableModel(sequence.shared_connectivity(), sequence.frame(0), none, none)};
  const NamedData read{"it", model, {.path = "models/it"}};
  const NamedData larger =
      derived(read, {array("neutral", MIMETRA_F64, {kVertices, 3}, moved.data())});
  EXPECT_EQ(larger.origin.path, "models/it");
  EXPECT_EQ(std::get<ModelData>(larger.data).model.mean(), moved);
}

/// Images that nobody looks at.
class UnseenImages final : public ImageSequence {
 public:
  explicit UnseenImages(int frames) : frames_(frames) {}
  int frames() const override { return frames_; }
  Image image(int frame) const override { throw std::logic_error(name(frame)); }
  std::string name(int frame) const override { return std::to_string(frame) + ".png"; }
  void check() const override {}

 private:
  int frames_;
};

TEST(DerivedData, KeepsTheImagesOfAsManyFrames) {
  LandmarkTrack track;
  track.points = Frames::Zero(2, 2);
  track.names = {"nose"};
  track.times = Eigen::Vector2d(0, 1);
  const auto images = std::make_shared<const UnseenImages>(2);
  const NamedData read{"it", track, {.images = images, .frame_notes = {"", "dark"}}};
  const double points[] = {1, 2, 3, 4, 5, 6};
  const Origin moved = derived(read, {array("points", MIMETRA_F64, {2, 1, 2}, points)}).origin;
  EXPECT_EQ(moved.images, images);
  EXPECT_THAT(moved.frame_notes, ElementsAre("", "dark"));
  const double times[] = {0, 1, 2};
  const Origin longer = derived(read, {array("points", MIMETRA_F64, {3, 1, 2}, points),
                                       array("times", MIMETRA_F64, {3}, times)})
                            .origin;
  EXPECT_EQ(longer.images, nullptr);
  EXPECT_TRUE(longer.frame_notes.empty());
}

TEST(DerivedData, KeepsTheMeshOfRegions) {
  const MeshSequence sequence = moving_take();
  const Regions regions = regions_from_vertices(kVertices, sequence.triangles(), {{0}});
  const RegionData base{regions, {sequence, fields_of(regions), true}};
  const std::uint8_t masks[2 * kVertices] = {1, 0, 0, 0, 0, 0, 0, 1};
  const mimetra_array two_masks = array("masks", MIMETRA_U8, {2, kVertices}, masks);
  const RegionData two = derived(base, {two_masks});
  EXPECT_EQ(two.regions.regions.size(), 2u);
  EXPECT_EQ(two.fields.sequence().frames(), 2);
  // Its fields are those of the new regions.
  const auto roi = std::ranges::find(two.fields.fields, "roi", &Field::name);
  ASSERT_NE(roi, two.fields.fields.end());
  EXPECT_EQ(roi->values.sum(), 2);
  const RegionData bare{regions, {}, sequence.shared_connectivity()};
  EXPECT_EQ(derived(bare, {two_masks}).faces, sequence.shared_connectivity());
}

TEST(DerivedData, KeepsTheWeightsOfRegionsUnlessTheirMasksChange) {
  const MeshSequence sequence = moving_take();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(kVertices);
  weights[0] = 1;
  weights[1] = 0.5;
  const Regions regions = painted_region(weights, sequence.triangles());
  const RegionData base{regions, {sequence, fields_of(regions), true}};
  EXPECT_EQ(derived(base, {}).regions.weights, weights);
  weights[1] = 0.25;
  const mimetra_array changed =
      array("weight", MIMETRA_F64, {kVertices}, weights.data(), MIMETRA_ON_VERTICES);
  EXPECT_EQ(derived(base, {changed}).regions.weights, weights);
  const std::uint8_t masks[kVertices] = {1, 1, 1, 0};
  const mimetra_array mask = array("masks", MIMETRA_U8, {1, kVertices}, masks);
  EXPECT_EQ(derived(base, {mask}).regions.weights.size(), 0);
  weights[1] = 2;
  EXPECT_THAT([&] { derived(base, {changed}); },
              ThrowsMessage<IoError>(HasSubstr("array 'weight': vertex 1 has the weight 2")));
}

TEST(DerivedData, TellsFieldsOnVerticesFromThoseOnTriangles) {
  const MeshSequence sequence = moving_take();
  const FieldSequence base(
      sequence,
      {{"energy", Field::Location::vertices, Eigen::MatrixXd::Ones(kVertices, 1), false},
       {"energy", Field::Location::triangles, Eigen::MatrixXd::Ones(kTriangles, 1), false},
       {"rest", Field::Location::vertices, Eigen::MatrixXd::Ones(kVertices, 3), false},
       {"corners", Field::Location::vertices, Eigen::MatrixXd::Ones(kVertices, 1), true}});
  const double energies[kTriangles] = {5, 5, 5, 5};
  const auto changed =
      derived(base, {array("energy", MIMETRA_F64, {kTriangles}, energies, MIMETRA_ON_TRIANGLES)});
  ASSERT_EQ(changed.fields.size(), 4u);
  for (const Field& field : changed.fields) {
    const bool is_changed = field.location == Field::Location::triangles;
    EXPECT_EQ(field.values(0, 0), is_changed ? 5 : 1) << field.name;
  }
  EXPECT_FALSE(changed.sequence().rest_is_known());
}

TEST(DerivedData, TakesComponentsWithoutWeightsAndSupport) {
  const Components bare = components();
  const double scale[] = {2};
  const Components derived_one = derived(bare, {array("scale", MIMETRA_F64, {1}, scale)});
  EXPECT_EQ(derived_one.weights.size(), 0);
  EXPECT_EQ(derived_one.support.size(), 0);
  EXPECT_EQ(derived_one.displacements, bare.displacements);
}

TEST(MadeData, HoldsSomething) {
  const double none[] = {0};
  const char* const no_names[] = {nullptr};
  const auto refuses = [](mimetra_kind kind, const std::vector<mimetra_array>& arrays,
                          const char* message) {
    EXPECT_THAT([&] { made(kind, arrays); }, ThrowsMessage<IoError>(HasSubstr(message)));
  };
  refuses(MIMETRA_PICTURES, {array("pixels", MIMETRA_U8, {0, 0, 3}, none)}, "with H at least 1");
  refuses(MIMETRA_LANDMARKS,
          {array("points", MIMETRA_F64, {0, 1, 2}, none),
           array("names", MIMETRA_STRING, {0}, no_names)},
          "with F at least 1");
  refuses(MIMETRA_LANDMARKS,
          {array("points", MIMETRA_F64, {1, 0, 2}, none),
           array("names", MIMETRA_STRING, {0}, no_names)},
          "needs a landmark or more");
  refuses(MIMETRA_SEQUENCE, {array("positions", MIMETRA_F64, {1, 0, 3}, none)}, "with N at least");
  EXPECT_TRUE(
      std::get<Table>(made(MIMETRA_TABLE, {array("x", MIMETRA_F64, {0}, none)}).data).rows.empty());
}

TEST(MadeData, IsASequenceWithOrWithoutFields) {
  const double positions[3 * kVertices] = {};
  const std::int32_t corners[] = {0, 1, 2};
  const std::vector<mimetra_array> bare = {
      array("positions", MIMETRA_F64, {kVertices, 3}, positions),
      array("triangles", MIMETRA_I32, {1, 3}, corners)};
  EXPECT_TRUE(std::get<FieldSequence>(made(MIMETRA_SEQUENCE, bare).data).fields.empty());
  std::vector<mimetra_array> shown = bare;
  shown.push_back(array("area", MIMETRA_F64, {1}, positions, MIMETRA_ON_TRIANGLES));
  const NamedData with_fields = made(MIMETRA_SEQUENCE, shown);
  ASSERT_EQ(std::get<FieldSequence>(with_fields.data).fields.size(), 1u);
  EXPECT_EQ(std::get<FieldSequence>(with_fields.data).fields.front().name, "area");
}

TEST(MadeData, IsAModelWithOrWithoutIdentitiesAndAPerformance) {
  const double numbers[3 * kVertices] = {};
  const std::int32_t corners[] = {0, 1, 2};
  const char* const names[] = {"wide"};
  std::vector<mimetra_array> arrays = {array("neutral", MIMETRA_F64, {kVertices, 3}, numbers),
                                       array("triangles", MIMETRA_I32, {1, 3}, corners)};
  EXPECT_EQ(std::get<ModelData>(made(MIMETRA_MODEL, arrays).data).performance.weights.size(), 0);
  arrays.push_back(array("identities", MIMETRA_F64, {1, kVertices, 3}, numbers));
  arrays.push_back(array("identity_names", MIMETRA_STRING, {1}, names));
  arrays.push_back(array("weights", MIMETRA_F64, {2, 1}, numbers));
  EXPECT_THAT([&] { made(MIMETRA_MODEL, arrays); },
              ThrowsMessage<UsageError>(HasSubstr("needs the array 'weight_names'")));
  arrays.push_back(array("weight_names", MIMETRA_STRING, {1}, names));
  const NamedData model = made(MIMETRA_MODEL, arrays);
  EXPECT_THAT(std::get<ModelData>(model.data).model.identities().names, ElementsAre("wide"));
  EXPECT_EQ(std::get<ModelData>(model.data).performance.weights.rows(), 2);
}

TEST(MadeData, SaysWhatIsOddAboutIt) {
  const test::Shape grid = test::grid(4, 4);
  const Frames neutral = grid.positions, aside = Frames::Constant(16, 3, 9);
  const Eigen::Matrix<std::int32_t, -1, 3, Eigen::RowMajor> corners = grid.triangles;
  const double weights[] = {0, 1}, times[] = {0, 1};
  const char* const names[] = {"smile"};
  const NamedData model =
      made(MIMETRA_MODEL, {array("neutral", MIMETRA_F64, {16, 3}, neutral.data()),
                           array("triangles", MIMETRA_I32, {18, 3}, corners.data()),
                           array("expressions", MIMETRA_F64, {1, 16, 3}, aside.data()),
                           array("expression_names", MIMETRA_STRING, {1}, names),
                           array("weights", MIMETRA_F64, {2, 1}, weights),
                           array("weight_names", MIMETRA_STRING, {1}, names),
                           array("times", MIMETRA_F64, {2}, times)});
  EXPECT_THAT(model.origin.notes, ElementsAre(AllOf(StartsWith("it: expressions of another place"),
                                                    HasSubstr("smile"))));
}

TEST(MadeData, HasTimesThatRise) {
  const double positions[2 * 3 * kVertices] = {}, times[] = {0, 0.5, 0.5};
  const std::int32_t corners[] = {0, 1, 2};
  const auto at = [&](const double* two) {
    return made(MIMETRA_SEQUENCE, {array("positions", MIMETRA_F64, {2, kVertices, 3}, positions),
                                   array("triangles", MIMETRA_I32, {1, 3}, corners),
                                   array("times", MIMETRA_F64, {2}, two)});
  };
  EXPECT_THAT(at(times).origin.notes, IsEmpty());
  EXPECT_THAT(
      [&] { at(times + 1); },
      ThrowsMessage<IoError>(HasSubstr("'times' holds 0.5 at [1], expected more than 0.5")));
}

TEST(MadeData, IsOnePictureOrADocument) {
  const std::uint8_t pixels[] = {1, 2, 3, 4, 5, 6};
  const NamedData picture =
      made(MIMETRA_PICTURES, {array("pixels", MIMETRA_U8, {2, 1, 3}, pixels)});
  const auto& pictures = std::get<Pictures>(picture.data);
  ASSERT_EQ(pictures.count, 1);
  EXPECT_EQ(pictures.draw(0).height, 2);
  const char* const text[] = {"<html>"};
  const NamedData page = made(MIMETRA_DOCUMENT, {array("text", MIMETRA_STRING, {1}, text)});
  EXPECT_EQ(std::get<Document>(page.data).text, "<html>");
}

TEST(MadeData, TakesNoPartOfAPointer) {
  const double values[3] = {};
  mimetra_array column = array("x", MIMETRA_F64, {3}, values);
  for (const std::size_t bytes : {1U, 4U, 7U}) {
    column.struct_size = static_cast<std::uint32_t>(offsetof(mimetra_array, name) + bytes);
    EXPECT_THAT([&] { made(MIMETRA_TABLE, {column}); },
                ThrowsMessage<UsageError>(HasSubstr("has no name")));
  }
}

TEST(MadeData, SaysWhereALocationIsWrong) {
  const double positions[3 * kVertices] = {};
  const auto refuses = [&](mimetra_kind kind, const mimetra_array& one, const char* message) {
    EXPECT_THAT([&] { made(kind, {one}); }, ThrowsMessage<UsageError>(HasSubstr(message)));
  };
  refuses(MIMETRA_SEQUENCE,
          array("positions", MIMETRA_F64, {kVertices, 3}, positions, MIMETRA_ON_VERTICES),
          "'positions' has a location, which only fields have");
  refuses(MIMETRA_TABLE, array("x", MIMETRA_F64, {3}, positions, MIMETRA_ON_VERTICES),
          "'x' has a location");
  refuses(MIMETRA_TABLE, array("x", MIMETRA_F64, {3}, positions, 3), "the location 3");
}

}  // namespace
}  // namespace mimetra
