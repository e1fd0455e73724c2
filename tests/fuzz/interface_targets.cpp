#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>

#include <fuzzer/FuzzedDataProvider.h>

#include "plugins/c/interface.h"
#include "plugins/c/value.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/values.h"
#include "toolkit/io/whole_file.h"

namespace mimetra::fuzz {

namespace {

using Bytes = FuzzedDataProvider;

const mimetra_interface& m() {
  return toolkit_interface();
}

/// One for all inputs: its table is large.
mimetra_context* context() {
  static mimetra_context* const made = [] {
    mimetra_context* empty = nullptr;
    m().new_context(nullptr, nullptr, &empty);
    m().set_threads(empty, 1);
    return empty;
  }();
  return made;
}

/// Handles, freed with it.
struct Handles {
  std::deque<mimetra_data*> data = {};
  mimetra_call* call = nullptr;

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    m().free_call(call);
    for (mimetra_data* each : data) m().free_data(each);
  }

  /// A place for the next value.
  mimetra_data** next() { return &data.emplace_back(nullptr); }
};

/// Arrays that a host might hand over: sound ones, changed here and there.
class Arrays {
 public:
  Arrays(Bytes& bytes, const mimetra_array* const* sound) {
    for (; *sound; ++sound) {
      if (bytes.ConsumeIntegralInRange(0, 15) == 0) continue;
      add(bytes, **sound);
    }
    if (bytes.ConsumeBool()) add_field(bytes);
    for (const mimetra_array& array : arrays_) list_.push_back(&array);
    list_.push_back(nullptr);
  }

  const mimetra_array* const* list() const { return list_.data(); }

 private:
  static constexpr std::array<std::size_t, 6> kSizes = {0, 8, 4, 4, 1, sizeof(char*)};

  void add(Bytes& bytes, const mimetra_array& sound) {
    mimetra_array& array = arrays_.emplace_back(sound);
    switch (bytes.ConsumeIntegralInRange(0, 11)) {
      case 0:
        array.name = texts_.emplace_back(bytes.ConsumeRandomLengthString(12)).c_str();
        break;
      case 1:
        array.location = bytes.ConsumeIntegralInRange(-1, 3);
        break;
      case 2:
        array.rank = bytes.ConsumeIntegralInRange(-1, 5);
        refill(bytes, array);
        break;
      case 3:
        array.type = bytes.ConsumeIntegralInRange(-1, 6);
        refill(bytes, array);
        break;
      case 4:
        array.shape[bytes.ConsumeIntegralInRange(0, 3)] =
            bytes.ConsumeBool() ? bytes.ConsumeIntegralInRange(0, 12)
                                : bytes.ConsumeIntegral<std::int64_t>();
        refill(bytes, array);
        break;
      case 5:
        array.struct_size = bytes.ConsumeIntegral<std::uint32_t>();
        break;
      case 6:
      case 7:
        refill(bytes, array);
        break;
      default:
        break;
    }
  }

  void add_field(Bytes& bytes) {
    mimetra_array& array = arrays_.emplace_back();
    array = {sizeof array,
             bytes.ConsumeIntegralInRange(1, 4),
             1,
             bytes.ConsumeIntegralInRange(1, 2),
             {9, 1, 1, 1},
             "more",
             nullptr};
    refill(bytes, array);
  }

  /// As many values as the array says it has; none where no memory could hold them.
  void refill(Bytes& bytes, mimetra_array& array) {
    constexpr std::size_t kMost = 1 << 16;
    array.values = nullptr;
    if (array.type < 1 || array.type > MIMETRA_STRING || array.rank < 1 || array.rank > 4) return;
    std::size_t count = 1;
    for (int i = 0; i < array.rank; ++i) {
      if (array.shape[i] < 0 || static_cast<std::size_t>(array.shape[i]) > kMost / count) return;
      count *= static_cast<std::size_t>(array.shape[i]);
      if (count == 0) break;
    }
    std::vector<char>& values =
        values_.emplace_back((count + 1) * kSizes[static_cast<std::size_t>(array.type)]);
    for (std::size_t i = 0; i < count; ++i) put(bytes, array.type, i, values.data());
    array.values = values.data();
  }

  void put(Bytes& bytes, int type, std::size_t i, char* values) {
    const auto put_as = [&](auto value) {
      std::memcpy(values + i * sizeof value, &value, sizeof value);
    };
    switch (type) {
      case MIMETRA_F64:
        return put_as(number(bytes));
      case MIMETRA_F32:
        return put_as(static_cast<float>(number(bytes)));
      case MIMETRA_I32:
        return put_as(bytes.ConsumeBool() ? bytes.ConsumeIntegralInRange(-1, 9)
                                          : bytes.ConsumeIntegral<std::int32_t>());
      case MIMETRA_U8:
        return put_as(bytes.ConsumeIntegral<std::uint8_t>());
      default:
        return put_as(bytes.ConsumeIntegralInRange(0, 15) == 0
                          ? nullptr
                          : texts_.emplace_back(bytes.ConsumeRandomLengthString(12)).c_str());
    }
  }

  static double number(Bytes& bytes) {
    static constexpr std::array<double, 8> kOdd = {0,
                                                   -1,
                                                   1e300,
                                                   -1e300,
                                                   1e39,
                                                   1e-320,
                                                   std::numeric_limits<double>::infinity(),
                                                   std::numeric_limits<double>::quiet_NaN()};
    return bytes.ConsumeIntegralInRange(0, 15) == 0 ? bytes.PickValueInArray(kOdd)
                                                    : bytes.ConsumeIntegralInRange(-40, 40) / 8.0;
  }

  std::deque<mimetra_array> arrays_;
  std::deque<std::string> texts_;
  std::deque<std::vector<char>> values_;
  std::vector<const mimetra_array*> list_;
};

/// A sound value of a kind.
mimetra_data* sound(Handles& held, int kind) {
  Data value = value_of(DataKind(kind - MIMETRA_SEQUENCE));
  *held.next() =
      new mimetra_data{std::make_shared<const Value>(NamedData{"sound", std::move(value)})};
  return held.data.back();
}

/// The same of changed arrays; null where that is refused.
mimetra_data* changed(Bytes& bytes, Handles& held, int kind) {
  const mimetra_array* const* all = nullptr;
  mimetra_data* base = sound(held, kind);
  if (m().data_arrays(context(), base, &all) != MIMETRA_OK) return nullptr;
  const Arrays arrays(bytes, all);
  mimetra_data** made = held.next();
  if (bytes.ConsumeBool()) {
    m().new_data(context(), kind, "made", arrays.list(), made);
  } else {
    m().derive_data(context(), base, arrays.list(), made);
  }
  return *made;
}

/// Reads everything of a value, and writes it.
void look_at(Bytes& bytes, mimetra_data* data, const fs::path& folder) {
  static constexpr std::array<const char*, 13> kExtensions = {
      "/",     ".npy", ".npz", ".pc2", ".mdd",  ".h5",    ".glb",
      ".gltf", ".obj", ".stl", ".csv", ".json", ".vtkhdf"};
  const char* json = nullptr;
  const mimetra_array* const* arrays = nullptr;
  m().data_json(context(), data, &json);
  m().data_arrays(context(), data, &arrays);
  const std::string path = (folder / "saved").string() + bytes.PickValueInArray(kExtensions);
  const std::array<const char*, 2> settings = {"force=true", nullptr};
  m().save_data(context(), data, path.c_str(), settings.data());
}

/// One of a list that ends with NULL and is not empty.
template <typename Item>
Item any_of(Bytes& bytes, const Item* list) {
  std::size_t count = 0;
  while (list[count]) ++count;
  return list[bytes.ConsumeIntegralInRange<std::size_t>(0, count - 1)];
}

std::string value_for(Bytes& bytes, const mimetra_parameter& parameter) {
  switch (bytes.ConsumeIntegralInRange(0, 3)) {
    case 0:
      return bytes.ConsumeRandomLengthString(16);
    case 1:
      return parameter.choices && *parameter.choices ? any_of(bytes, parameter.choices)
             : bytes.ConsumeBool()                   ? "true"
                                                     : "false";
    case 2:
      return std::to_string(bytes.ConsumeIntegralInRange(-2, 40) / 4.0);
    default:
      return std::to_string(bytes.ConsumeIntegralInRange(-2, 12));
  }
}

/// Calls an operation with sound and changed values, and any of its parameters.
void call(Bytes& bytes, Handles& held, const fs::path& folder) {
  const mimetra_operation& operation = *any_of(bytes, m().operations(context()));
  if (m().new_call(context(), operation.name, &held.call) != MIMETRA_OK) return;
  for (const mimetra_port* const* input = operation.inputs; *input; ++input) {
    if (bytes.ConsumeIntegralInRange(0, 7) == 0) continue;
    mimetra_data* data = bytes.ConsumeIntegralInRange(0, 2) == 0
                             ? changed(bytes, held, (*input)->kind)
                             : sound(held, (*input)->kind);
    m().call_give(held.call, (*input)->name, data);
  }
  for (int i = bytes.ConsumeIntegralInRange(0, 5); i > 0 && *operation.parameters; --i) {
    const mimetra_parameter& parameter = *any_of(bytes, operation.parameters);
    if (parameter.of_files) continue;
    m().call_set(held.call, parameter.name, value_for(bytes, parameter).c_str());
  }
  for (const mimetra_port* const* output = operation.outputs; *output; ++output) {
    if (bytes.ConsumeBool()) m().call_want(held.call, (*output)->name);
  }
  if (m().call_run(held.call) != MIMETRA_OK) return;
  for (const mimetra_port* const* output = operation.outputs; *output; ++output) {
    for (int i = 0; i < m().call_output_count(held.call, (*output)->name); ++i) {
      mimetra_data** made = held.next();
      m().call_output(held.call, (*output)->name, i, made);
      look_at(bytes, *made, folder);
    }
  }
}

/// Cancels what would take long.
std::int32_t go_on(double, void* user) {
  constexpr int kPatience = 200;
  return ++*static_cast<int*>(user) < kPatience ? 1 : 0;
}

void use(const fs::path& file) {
  const std::string content = read_file(file);
  Bytes bytes(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  int calls = 0;
  Handles held;
  m().set_progress(context(), go_on, &calls);
  if (bytes.ConsumeBool()) {
    call(bytes, held, file.parent_path());
  } else {
    const int kind = bytes.ConsumeIntegralInRange<int>(MIMETRA_SEQUENCE, MIMETRA_DOCUMENT);
    if (mimetra_data* data = changed(bytes, held, kind)) {
      look_at(bytes, data, file.parent_path());
    }
  }
}

}  // namespace

std::vector<Target> interface_targets() {
  return {{"c_interface", "calls.bin", use, {text(std::string(400, '\x5a')), text("")}}};
}

}  // namespace mimetra::fuzz
