#include <algorithm>
#include <cstring>
#include <fstream>
#include <span>

#include <gmock/gmock.h>

#include "tests/io/hdf5_library.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/hdf5/components_file.h"
#include "toolkit/formats/hdf5/hdf5_file.h"
#include "toolkit/formats/hdf5/hdf5_image.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::counted_up;
using test::Hdf5Made;
using test::in_chunks;
using testing::ElementsAre;
using testing::HasSubstr;

class Hdf5 : public testing::Test {
 protected:
  std::string message_of(const std::string& name) const {
    return test::message_of<IoError>([&] { Hdf5File(file_).dataset(name).values(); });
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.h5";
};

TEST_F(Hdf5, NumbersOfEveryTypeAreThoseOfTheLibrary) {
  const std::vector<std::pair<std::string, hid_t>> types = {
      {"i8", H5T_STD_I8LE},      {"u8", H5T_STD_U8BE},    {"i16", H5T_STD_I16BE},
      {"u16", H5T_STD_U16LE},    {"i32", H5T_STD_I32LE},  {"u32", H5T_STD_U32BE},
      {"i64", H5T_STD_I64BE},    {"u64", H5T_STD_U64LE},  {"f32", H5T_IEEE_F32LE},
      {"f32be", H5T_IEEE_F32BE}, {"f64", H5T_IEEE_F64LE}, {"f64be", H5T_IEEE_F64BE}};
  const auto values = counted_up({5, 7});
  {
    const Hdf5Made made(file_);
    for (const auto& [name, type] : types) made.add(name, {5, 7}, values, type);
  }
  const Hdf5File file(file_);
  for (const auto& [name, type] : types) {
    EXPECT_EQ(file.dataset(name).values(), values) << name;
    EXPECT_THAT(file.dataset(name).shape(), ElementsAre(5, 7));
  }
}

TEST_F(Hdf5, NumbersInEveryLayoutAreThoseOfTheLibrary) {
  const std::vector<std::pair<std::string, Hdf5Made::Change>> layouts = {
      {"contiguous", {}},
      {"compact", [](hid_t creation) { H5Pset_layout(creation, H5D_COMPACT); }},
      {"chunked", in_chunks({4, 5, 2})},
      {"one_block", in_chunks({13, 40, 3})},
      {"deflate", in_chunks({3, 40, 1}, [](hid_t set) { H5Pset_deflate(set, 4); })},
      {"all_filters", in_chunks({7, 9, 3},
                                [](hid_t set) {
                                  H5Pset_shuffle(set);
                                  H5Pset_deflate(set, 9);
                                  H5Pset_fletcher32(set);
                                })},
      {"checksum_first", in_chunks({7, 9, 3}, [](hid_t set) {
         H5Pset_fletcher32(set);
         H5Pset_deflate(set, 1);
       })}};
  const Hdf5Made::Sizes sizes = {13, 40, 3};
  const auto values = counted_up(sizes);
  {
    const Hdf5Made made(file_);
    for (const auto& [name, change] : layouts) {
      made.add(name, sizes, values, H5T_IEEE_F32LE, change);
    }
  }
  const Hdf5File file(file_);
  for (const auto& [name, change] : layouts) {
    const Hdf5Dataset set = file.dataset(name);
    EXPECT_EQ(set.values(), values) << name;
    for (std::size_t first = 0; first < 12; ++first) {
      std::vector<double> rows(2 * 120);
      set.read(first, rows);
      EXPECT_EQ(rows.front(), 120.0 * static_cast<double>(first)) << name;
      EXPECT_EQ(rows.back(), rows.front() + 239) << name;
    }
  }
}

TEST_F(Hdf5, RowsOfBlocksThatAreKeptInAFileAreThoseOfTheLibrary) {
  // Of 26 MB, all in one row of blocks.
  const Hdf5Made::Sizes sizes = {1000, 1100, 3};
  const auto values = counted_up(sizes);
  {
    const Hdf5Made made(file_);
    made.add("tall", sizes, values, H5T_IEEE_F64LE,
             in_chunks({1000, 300, 2}, [](hid_t set) { H5Pset_deflate(set, 1); }));
  }
  const Hdf5Dataset set = Hdf5File(file_).dataset("tall");
  EXPECT_TRUE(set.values() == values);
  std::vector<double> rows(3 * 3300);
  set.read(500, rows);
  EXPECT_TRUE(std::ranges::equal(rows, std::span(values).subspan(500 * 3300, 3 * 3300)));
}

TEST_F(Hdf5, ThatLeadsElsewhereIsRefused) {
  std::ofstream(folder_ / "secret") << std::string(1000, 's');
  const auto values = counted_up({4, 3});
  {
    const Hdf5Made other(folder_ / "other.h5");
    other.add("verts", {4, 3}, values);
  }
  {
    const Hdf5Made made(file_);
    made.add("external", {4, 3}, {}, H5T_STD_I8LE,
             [this](hid_t set) { H5Pset_external(set, (folder_ / "secret").c_str(), 0, 12); });
    made.add("virtual", {4, 3}, {}, H5T_IEEE_F64LE, [this](hid_t set) {
      const hsize_t sizes[2] = {4, 3};
      const hid_t space = H5Screate_simple(2, sizes, nullptr);
      H5Pset_virtual(set, space, (folder_ / "other.h5").c_str(), "verts", space);
      H5Sclose(space);
    });
    H5Lcreate_soft("/external", made.id(), "soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external((folder_ / "other.h5").c_str(), "/verts", made.id(), "link", H5P_DEFAULT,
                       H5P_DEFAULT);
  }
  EXPECT_THAT(message_of("external"), HasSubstr("keeps its numbers in another file"));
  EXPECT_THAT(message_of("virtual"), HasSubstr("made of other datasets"));
  EXPECT_THAT(message_of("soft"), HasSubstr("'soft' is a link to elsewhere"));
  EXPECT_THAT(message_of("link"), HasSubstr("'link' is a link to elsewhere"));
}

TEST_F(Hdf5, FiltersBeyondItsOwnAreRefusedByName) {
  constexpr H5Z_filter_t kLzf = 32000;
  {
    const Hdf5Made made(file_);
    made.add("lzf", {4, 3}, counted_up({4, 3}), H5T_IEEE_F64LE, in_chunks({4, 3}, [](hid_t set) {
               H5Pset_filter(set, kLzf, H5Z_FLAG_OPTIONAL, 0, nullptr);
             }));
  }
  EXPECT_THAT(message_of("lzf"), HasSubstr("dataset 'lzf' is stored by the filter 32000"));
  EXPECT_THAT(message_of("lzf"), HasSubstr("h5repack"));
}

TEST_F(Hdf5, WithoutNumbersIsRefused) {
  {
    const Hdf5Made made(file_);
    made.add("never", {1ull << 40, 3}, {});
    made.add("no_block", {1ull << 30, 3}, {}, H5T_IEEE_F64LE, in_chunks({1000, 3}));
    const hid_t group = H5Gcreate2(made.id(), "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
  }
  EXPECT_THAT(message_of("never"), HasSubstr("dataset 'never' holds no numbers"));
  EXPECT_THAT(message_of("no_block"), HasSubstr("claims more numbers than the file holds"));
  EXPECT_THAT(message_of("group"), HasSubstr("dataset 'group' is no array"));
  EXPECT_THAT(message_of("other"), HasSubstr("has no dataset 'other'"));
}

/// Puts another number in place of one that stands in a file once or more, by eight bytes.
void replace_number(const std::filesystem::path& path, std::uint64_t number, std::uint64_t other) {
  std::string bytes = read_file(path);
  std::string stored(8, '\0');
  std::memcpy(stored.data(), &number, 8);
  int found = 0;
  for (auto at = bytes.find(stored); at != std::string::npos; at = bytes.find(stored, at + 8)) {
    std::memcpy(bytes.data() + at, &other, 8);
    ++found;
  }
  EXPECT_GT(found, 0);
  write_bytes(path, bytes);
}

TEST_F(Hdf5, ClaimsAreComparedWithTheFileBeforeAnythingIsAllocated) {
  const auto make = [this](const Hdf5Made::Change& change) {
    const Hdf5Made made(file_);
    made.add("set", {1237, 3}, counted_up({1237, 3}), H5T_IEEE_F64LE, change);
  };
  make({});
  replace_number(file_, 1237, 1ull << 50);
  EXPECT_THAT(message_of("set"), HasSubstr("claims more numbers than the file holds"));
  make({});
  replace_number(file_, 1237, 1ull << 62);
  EXPECT_THAT(message_of("set"), HasSubstr("claims more numbers than the file holds"));
  make({});
  // What the layout says of the numbers' bytes.
  replace_number(file_, 8 * 3 * 1237, 16);
  EXPECT_THAT(message_of("set"), HasSubstr("claims more numbers than the file holds"));
  make(in_chunks({1237, 3}, [](hid_t set) { H5Pset_deflate(set, 9); }));
  replace_number(file_, 1237, 1ull << 40);
  EXPECT_THAT(message_of("set"), HasSubstr("claims more numbers than the file holds"));
}

TEST_F(Hdf5, RowsWithoutNumbersAreNoMoreThanTheFileHasBytes) {
  for (const auto& [rows, columns] : {std::pair(1ull << 50, 0ull), std::pair(0ull, 1ull << 50)}) {
    {
      const Hdf5Made made(file_);
      made.add("set", {rows, columns}, {});
      made.add("empty", {4, 0}, {});
    }
    EXPECT_THAT(message_of("set"), HasSubstr("claims more rows than the file has bytes"));
    EXPECT_EQ(Hdf5File(file_).dataset("empty").shape()[0], 4);
  }
}

/// Reads all that there is.
void read_all(const std::filesystem::path& path) {
  const Hdf5File file(path);
  for (const std::string& name : file.names()) {
    try {
      file.dataset(name).values();
    } catch (const IoError&) {
      continue;
    }
  }
}

TEST_F(Hdf5, WithAnyByteChangedIsReadOrRefusedAndNothingElse) {
  for (const bool latest : {false, true}) {
    {
      const Hdf5Made made(file_, latest);
      made.add("a", {5, 3}, counted_up({5, 3}), H5T_IEEE_F32LE);
      made.add("b", {5, 3}, counted_up({5, 3}), H5T_STD_I32LE,
               in_chunks({5, 3}, [](hid_t set) { H5Pset_deflate(set, 9); }));
      made.add("c", {4, 3}, counted_up({4, 3}), H5T_IEEE_F64LE,
               [](hid_t set) { H5Pset_layout(set, H5D_COMPACT); });
    }
    std::string bytes = read_file(file_);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const int value : {0x01, 0xff}) {
        const char old = std::exchange(bytes[at], static_cast<char>(value));
        if (old == bytes[at]) continue;
        write_bytes(file_, bytes);
        try {
          read_all(file_);
        } catch (const IoError&) {
        }
        bytes[at] = old;
      }
    }
  }
}

TEST_F(Hdf5, PartsThatReferToOneAnotherInACircleComeToAnEnd) {
  {
    const Hdf5Made made(file_);
    made.add("set", {50, 3}, counted_up({50, 3}), H5T_IEEE_F64LE, in_chunks({1, 3}));
  }
  // A node of the index of blocks whose children are the node itself.
  std::string bytes = read_file(file_);
  for (auto at = bytes.find("TREE\1"); at != std::string::npos; at = bytes.find("TREE\1", at + 4)) {
    bytes[at + 5] = 1;
    const std::uint64_t itself = at;
    for (std::size_t child = at + 24 + 32; child + 8 <= bytes.size() && child < at + 2000;
         child += 40) {
      std::memcpy(bytes.data() + child, &itself, 8);
    }
  }
  write_bytes(file_, bytes);
  EXPECT_THAT(message_of("set"), HasSubstr("damaged"));
}

TEST(Hdf5Image, IsReadByTheLibrary) {
  const test::TemporaryFolder folder;
  const auto path = folder / "a.h5";
  const std::vector<double> numbers = {1, 2.5, -3};
  const std::vector<int> indices = {4, -5};
  Hdf5Image image;
  image.add("G/numbers", Hdf5Array::of(std::span<const double>(numbers)));
  image.add("G/H/indices", Hdf5Array::of(std::span<const int>(indices)));
  for (int i = 0; i < 1000; ++i) image.add("set" + std::to_string(i), Hdf5Array::of(i));
  image.add_attribute("", "options", Hdf5Array::of(2.5));
  image.add_attribute("G", "Type", Hdf5Array::of(std::string_view("PolyData")));
  image.add("empty", Hdf5Array::of(std::span<const int>()));
  image.reserve("G/later", Hdf5Array::Type::float64, {3});
  std::string bytes = image.image();
  bytes.resize(image.place_of("G/later"));
  bytes.append(reinterpret_cast<const char*>(numbers.data()), 24);
  write_bytes(path, bytes);
  EXPECT_EQ(test::library_values(path, "G/numbers"), numbers);
  EXPECT_EQ(test::library_values(path, "G/later"), numbers);
  EXPECT_THAT(test::library_values(path, "/G/H/indices"), ElementsAre(4, -5));
  EXPECT_THAT(test::library_values(path, "set999"), ElementsAre(999));
  EXPECT_THAT(test::library_shape(path, "empty"), ElementsAre(0));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  double option = 0;
  const hid_t attribute = H5Aopen(file, "options", H5P_DEFAULT);
  EXPECT_GE(H5Aread(attribute, H5T_NATIVE_DOUBLE, &option), 0);
  EXPECT_EQ(option, 2.5);
  H5Aclose(attribute);
  H5Fclose(file);
}

/// Files at which HDF5's library crashed, or which led it to others.
TEST(Hdf5OfTheHostile, IsAnError) {
  for (const char* name : {"evil.h5", "crash_78fbb.h5", "crash_e6265.h5"}) {
    const auto path = test::shared_path(std::string("data/hostile/") + name);
    MIMETRA_SKIP_WITHOUT(path);
    EXPECT_THROW(read_components(path), IoError) << name;
  }
}

}  // namespace
}  // namespace mimetra
