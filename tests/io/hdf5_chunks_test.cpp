#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <utility>

#include <gmock/gmock.h>

#include "tests/io/hdf5_library.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/hdf5/hdf5_file.h"
#include "toolkit/formats/hdf5/hdf5_parts.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::counted_up;
using test::Hdf5Made;
using test::in_chunks;
using testing::HasSubstr;
using testing::Not;

constexpr hsize_t kAny = H5S_UNLIMITED;

/// Dataset whose blocks HDF5's latest format lists in a way of its own, which its file shows by
/// signatures.
struct Listed {
  std::string name;
  Hdf5Made::Sizes sizes, most, chunk;
  std::vector<std::string> with, without = {};
  bool can_be_filtered = true;
};

std::vector<Listed> all_lists() {
  return {
      {"single", {8, 6}, {8, 6}, {8, 6}, {}, {"FAHD"}},
      {"implicit", {13, 10, 3}, {20, 14, 3}, {4, 3, 2}, {}, {"FAHD"}, false},
      {"fixed", {13, 10, 3}, {20, 14, 3}, {4, 3, 2}, {"FADB"}},
      {"paged", {1030}, {1100}, {1}, {"FADB"}},
      {"extensible", {100, 7}, {kAny, 20}, {2, 3}, {"EADB", "EASB"}},
      {"extensible_across", {7, 5, 50}, {11, 5, kAny}, {2, 5, 1}, {"EADB", "EASB"}},
      {"tree", {6, 10}, {kAny, kAny}, {4, 3}, {"BTLF"}, {"BTIN"}},
      {"deep_tree", {12, 10}, {kAny, kAny}, {1, 1}, {"BTLF", "BTIN"}},
  };
}

class Hdf5Chunks : public testing::Test {
 protected:
  std::string message_of(const std::string& name) const {
    return test::message_of<IoError>([&] { Hdf5File(file_).dataset(name).values(); });
  }

  void make(const Listed& list, hid_t stored, const Hdf5Made::Change& filters = {}) const {
    const Hdf5Made made(file_, true);
    add(made, list, counted_up(list.sizes), stored, filters);
  }

  static void add(const Hdf5Made& made, const Listed& list, const std::vector<double>& values,
                  hid_t stored, const Hdf5Made::Change& filters = {}) {
    made.add(list.name, list.sizes, values, stored,
             in_chunks(list.chunk,
                       [&](hid_t set) {
                         if (!list.can_be_filtered) H5Pset_alloc_time(set, H5D_ALLOC_TIME_EARLY);
                         if (filters) filters(set);
                       }),
             list.most);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.h5";
};

const std::vector<Hdf5Made::Change> kFilters = {
    {},
    [](hid_t set) { H5Pset_deflate(set, 1); },
    [](hid_t set) { H5Pset_fletcher32(set); },
    [](hid_t set) {
      H5Pset_shuffle(set);
      H5Pset_deflate(set, 9);
      H5Pset_fletcher32(set);
    },
    [](hid_t set) {
      H5Pset_deflate(set, 1);
      H5Pset_chunk_opts(set, H5D_CHUNK_DONT_FILTER_PARTIAL_CHUNKS);
    },
};

TEST_F(Hdf5Chunks, InEveryListAreThoseOfTheLibrary) {
  const std::vector<hid_t> types = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I64LE, H5T_STD_U16BE,
                                    H5T_IEEE_F64LE};
  for (const Listed& list : all_lists()) {
    for (std::size_t i = 0; i < kFilters.size(); ++i) {
      if (i > 0 && !list.can_be_filtered) continue;
      make(list, types[i], kFilters[i]);
      const std::string bytes = read_file(file_);
      for (const auto& signature : list.with) EXPECT_THAT(bytes, HasSubstr(signature));
      for (const auto& signature : list.without) EXPECT_THAT(bytes, Not(HasSubstr(signature)));
      EXPECT_TRUE(test::library_values(file_, list.name) == counted_up(list.sizes));
      EXPECT_TRUE(Hdf5File(file_).dataset(list.name).values() == counted_up(list.sizes))
          << list.name << " with filters " << i;
    }
  }
}

// It takes some seconds, since an extensible array has pages from the 131060th block on, and a tree
// three levels from the 5269th.
TEST_F(Hdf5Chunks, InLargeListsAreThoseOfTheLibrary) {
  for (const Listed& list : {Listed{"pages", {136000}, {kAny}, {1}, {}},
                             Listed{"tree", {90, 75}, {kAny, kAny}, {1, 1}, {}}}) {
    make(list, H5T_STD_I32LE);
    EXPECT_TRUE(Hdf5File(file_).dataset(list.name).values() == counted_up(list.sizes));
  }
}

TEST_F(Hdf5Chunks, WithSumsOfOddSizesAreThoseOfTheLibrary) {
  const std::vector<double> values = {1, 2, 3, 255, 254, 0, 0, 0, 0, 0, 0, 7};
  {
    const Hdf5Made made(file_);
    made.add("set", {12}, values, H5T_STD_U8LE, in_chunks({3}, kFilters[2]));
  }
  EXPECT_EQ(Hdf5File(file_).dataset("set").values(), values);
}

TEST_F(Hdf5Chunks, ThatAreMissingAreAnError) {
  for (const Listed& list : all_lists()) {
    if (!list.can_be_filtered || list.with.empty()) continue;
    Listed part = list;
    for (auto& size : part.sizes) size = (size + 3) / 4;
    {
      const Hdf5Made made(file_, true);
      add(made, list, {}, H5T_IEEE_F64LE);
      // The file must have more bytes than the dataset has blocks.
      made.add("other", {1000}, counted_up({1000}));
    }
    EXPECT_THAT(message_of(list.name), HasSubstr("holds no numbers for a part of it"));
    {
      const Hdf5Made made(file_, true);
      add(made, part, counted_up(part.sizes), H5T_IEEE_F64LE);
      made.resize(list.name, list.sizes);
    }
    EXPECT_THAT(message_of(list.name), HasSubstr("holds no numbers for a part of it"));
  }
}

TEST_F(Hdf5Chunks, WithAWrongSumAreAnError) {
  for (const bool latest : {false, true}) {
    {
      const Hdf5Made made(file_, latest);
      made.add("set", {5}, {1, 2, 3, 4, 1e300}, H5T_IEEE_F64LE,
               in_chunks({5}, [](hid_t set) { H5Pset_fletcher32(set); }));
    }
    std::string bytes = read_file(file_), number(8, '\0');
    const double last = 1e300;
    std::memcpy(number.data(), &last, 8);
    bytes[bytes.find(number)] ^= 1;
    write_bytes(file_, bytes);
    EXPECT_THAT(message_of("set"), HasSubstr("dataset 'set' has a wrong checksum"));
  }
}

TEST_F(Hdf5Chunks, OfGroupsWithManyLinksAndAttributesAreFound) {
  const auto values = counted_up({3, 2});
  const auto name = [](int i) { return std::string(200, 'n') + std::to_string(i); };
  {
    const Hdf5Made made(file_, true);
    made.add("set", {3, 2}, values);
    for (int i = 0; i < 3000; ++i) {
      H5Lcreate_hard(made.id(), "set", made.id(), name(i).c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
    // The file stores links and attributes of more than 4 kB elsewhere.
    H5Lcreate_hard(made.id(), "set", made.id(), std::string(5000, 'n').c_str(), H5P_DEFAULT,
                   H5P_DEFAULT);
    for (int i = 0; i < 20; ++i) {
      const hsize_t size = i == 7 ? 10000 : 1;
      const hid_t space = H5Screate_simple(1, &size, nullptr);
      const std::vector<double> numbers(size, i);
      const hid_t attribute = H5Acreate2(made.id(), ("number" + std::to_string(i)).c_str(),
                                         H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
      EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_DOUBLE, numbers.data()), 0);
      H5Aclose(attribute);
      H5Sclose(space);
    }
  }
  EXPECT_THAT(read_file(file_), HasSubstr("FHIB"));
  const Hdf5File file(file_);
  EXPECT_EQ(file.names().size(), 3001);
  for (int i = 0; i < 3000; i += 100) EXPECT_EQ(file.dataset(name(i)).values(), values);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(file.attribute("number" + std::to_string(i), -1), i == 7 ? -1 : i);
  }
}

TEST_F(Hdf5Chunks, OfHeadersInPartsOfVersion18AreFound) {
  std::vector<std::string> names;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
  const hid_t made = H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  for (char last = 'a'; last < 'h'; ++last) {
    names.push_back(std::string(150, 'n') + last);
    H5Gclose(H5Gcreate2(made, names.back().c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  H5Fclose(made);
  H5Pclose(access);
  const std::string bytes = read_file(file_);
  EXPECT_EQ(bytes[8], 2);
  EXPECT_THAT(bytes, HasSubstr("OCHK"));
  EXPECT_EQ(Hdf5File(file_).names(), names);
}

/// Part of a file that ends with its checksum.
struct Sealed {
  std::size_t begin, end;
};

std::vector<Sealed> sealed_parts(std::string_view bytes) {
  std::vector<Sealed> parts;
  for (const char* signature : {"\x89HDF", "OHDR", "OCHK", "FAHD", "FADB", "EAHD", "EAIB", "EASB",
                                "EADB", "BTHD", "BTIN", "BTLF", "FRHP", "FHIB"}) {
    for (auto at = bytes.find(signature); at != bytes.npos; at = bytes.find(signature, at + 4)) {
      for (std::size_t end = at + 12; end + 4 <= bytes.size(); ++end) {
        std::uint32_t sum = 0;
        std::memcpy(&sum, &bytes[end], 4);
        if (sum != hdf5_checksum(bytes.substr(at, end - at))) continue;
        parts.push_back({at, end});
        break;
      }
    }
  }
  return parts;
}

class Hdf5Damage : public Hdf5Chunks {
 protected:
  /// Changes bytes at random, and corrects the checksums if `resealed`. Calls `check` each time.
  void change_bytes(int times, bool resealed, const std::function<void()>& check) const {
    std::string bytes = read_file(file_);
    const auto parts = resealed ? sealed_parts(bytes) : std::vector<Sealed>{{0, bytes.size()}};
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    const auto put = [&file](std::size_t at, std::string_view text) {
      file.seekp(static_cast<std::streamoff>(at));
      file << text << std::flush;
    };
    std::mt19937 random(1);
    for (int i = 0; i < times; ++i) {
      const Sealed part = parts[random() % parts.size()];
      const std::size_t at = part.begin + random() % (part.end - part.begin);
      constexpr unsigned char kEnds[] = {0, 1, 0x7f, 0xff};
      const auto changed = random() % 2 == 0 ? kEnds[random() % 4] : random() % 256;
      const char old = std::exchange(bytes[at], static_cast<char>(changed));
      const std::string seal = resealed ? bytes.substr(part.end, 4) : "";
      put(at, {&bytes[at], 1});
      if (resealed) {
        const auto sum =
            hdf5_checksum(std::string_view(bytes).substr(part.begin, part.end - part.begin));
        put(part.end, {reinterpret_cast<const char*>(&sum), 4});
      }
      try {
        check();
      } catch (const IoError&) {
      }
      bytes[at] = old;
      put(at, {&bytes[at], 1});
      put(part.end, seal);
    }
  }
};

TEST_F(Hdf5Damage, IsFoundByTheChecksums) {
  for (const Listed& list : all_lists()) {
    if (!list.can_be_filtered) continue;
    make(list, H5T_IEEE_F32LE, kFilters[2]);
    const auto values = counted_up(list.sizes);
    change_bytes(300, false, [&] {
      const Hdf5File file(file_);
      if (file.has(list.name)) EXPECT_TRUE(file.dataset(list.name).values() == values);
    });
  }
}

TEST_F(Hdf5Damage, OfListsWithRightChecksumsIsReadOrRefused) {
  for (const Listed& list : all_lists()) {
    make(list, H5T_IEEE_F32LE, list.can_be_filtered ? kFilters[1] : kFilters[0]);
    change_bytes(300, true, [&] { Hdf5File(file_).dataset(list.name).values(); });
  }
}

}  // namespace
}  // namespace mimetra
