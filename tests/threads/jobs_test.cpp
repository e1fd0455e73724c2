#include <array>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "plugins/c/interface.h"
#include "plugins/c/plugin_description.h"
#include "plugins/c/value.h"
#include "tests/threads/together.h"

namespace mimetra {
namespace {

using test::kTogether;
using test::together;

const mimetra_interface& m() {
  return toolkit_interface();
}

/// A third party's operation: what it is given, after a call of the toolkit's own.
mimetra_status double_run(const mimetra_interface* table, mimetra_job* job, void*) {
  mimetra_context* context = table->job_context(job);
  mimetra_call* call = nullptr;
  const mimetra_data* take = table->job_input(job, "sequence", 0);
  mimetra_data* aligned = nullptr;
  mimetra_status status = table->new_call(context, "align", &call);
  if (!status) status = table->call_give(call, "sequence", take);
  if (!status) status = table->call_run(call);
  if (!status) status = table->job_progress(job, 0.5);
  if (!status) status = table->call_output(call, "out", 0, &aligned);
  if (!status) status = table->job_output(job, "out", aligned);
  table->free_data(aligned);
  table->free_call(call);
  return status;
}

/// The toolkit's operations and the third party's.
mimetra_context* new_context() {
  static const mimetra_port kIn{sizeof kIn, MIMETRA_SEQUENCE, "sequence", "a take", 0, 0};
  static const mimetra_port kOut{sizeof kOut, MIMETRA_SEQUENCE, "out", "the same", 0, 0};
  static const std::array<const mimetra_port*, 2> kIns = {&kIn, nullptr}, kOuts = {&kOut, nullptr};
  static const std::array<const mimetra_parameter*, 1> kNone = {nullptr};
  static const std::array<const char*, 3> kExamples = {"twice a.npy -o b.npy",
                                                       "twice a.glb -o b.glb", nullptr};
  mimetra_operation described = {};
  described.struct_size = sizeof described;
  described.name = "twice";
  described.summary = "Align a take";
  described.inputs = kIns.data();
  described.outputs = kOuts.data();
  described.parameters = kNone.data();
  described.examples = kExamples.data();
  described.run = double_run;
  static const auto toolkit = std::make_shared<const DescribedTable>(add_toolkit);
  mimetra_context* context = nullptr;
  make_context(
      [&described](OperationTable& table) {
        add_toolkit(table);
        table.add(plugin_operation(described, "test", toolkit));
        return std::vector<std::string>();
      },
      nullptr, nullptr, &context);
  return context;
}

/// What an operation makes of a take, as numbers.
std::vector<double> result_of(const char* operation, const mimetra_data* take, const char* array) {
  mimetra_context* context = new_context();
  mimetra_call* call = nullptr;
  mimetra_data* made = nullptr;
  const mimetra_array* shown = nullptr;
  std::vector<double> numbers;
  m().set_threads(context, 2);
  const bool is_done = m().new_call(context, operation, &call) == MIMETRA_OK &&
                       m().call_give(call, "sequence", take) == MIMETRA_OK &&
                       m().call_run(call) == MIMETRA_OK &&
                       m().call_output(call, "out", 0, &made) == MIMETRA_OK &&
                       m().data_array(context, made, array, &shown) == MIMETRA_OK;
  EXPECT_TRUE(is_done) << operation << ": " << m().message(context);
  if (is_done) {
    std::size_t count = 1;
    for (int i = 0; i < shown->rank; ++i) count *= static_cast<std::size_t>(shown->shape[i]);
    numbers.resize(count);
    std::memcpy(numbers.data(), shown->values, count * sizeof(double));
  }
  m().free_data(made);
  m().free_call(call);
  m().free_context(context);
  return numbers;
}

class Jobs : public testing::Test {
 protected:
  /// One value that all threads read, and of which nobody has asked for arrays before.
  const mimetra_data take_{
      std::make_shared<const Value>(NamedData{"take", FieldSequence(test::bulging_sphere(8))})};
};

TEST_F(Jobs, OfSeveralContextsReadOneValueAtOnce) {
  const auto run = [this](int i) {
    return i % 2 == 0 ? result_of("align", &take_, "positions")
                      : result_of("twice", &take_, "positions");
  };
  std::array<std::vector<double>, kTogether> results;
  together([&](int i) { results[static_cast<std::size_t>(i)] = run(i); });
  for (int i = 0; i < kTogether; ++i) EXPECT_EQ(results[static_cast<std::size_t>(i)], run(i)) << i;
}

TEST_F(Jobs, ShowOneValuesArraysToAllThreads) {
  std::array<const mimetra_array* const*, kTogether> shown{};
  together([&](int i) {
    mimetra_context* context = new_context();
    const char* json = nullptr;
    m().data_arrays(context, &take_, &shown[static_cast<std::size_t>(i)]);
    m().data_json(context, &take_, &json);
    m().free_context(context);
  });
  for (const auto* list : shown) EXPECT_EQ(list, shown[0]);
}

}  // namespace
}  // namespace mimetra
