// Plugins that cannot be used, one for each BROKEN_... that this is compiled with.

#include <iterator>
#include <stdexcept>

#include "plugins/c/mimetra.h"

namespace {

mimetra_status run(const mimetra_interface*, mimetra_job*, void*) {
  return MIMETRA_OK;
}

[[maybe_unused]] mimetra_operation operation_named(const char* name) {
  mimetra_operation operation{};
  operation.struct_size = sizeof operation;
  operation.name = name;
  operation.summary = "does nothing";
  operation.run = run;
  return operation;
}

[[maybe_unused]] mimetra_plugin plugin_of(const mimetra_operation* const* operations) {
  return {sizeof(mimetra_plugin), MIMETRA_INTERFACE_VERSION, "broken", operations, nullptr};
}

}  // namespace

#ifdef BROKEN_OTHER_VERSION
const mimetra_plugin* mimetra_get_plugin() {
  static const mimetra_operation operation = operation_named("of-other-version");
  static const mimetra_operation* const operations[] = {&operation, nullptr};
  static mimetra_plugin plugin = plugin_of(operations);
  plugin.version = 2;
  return &plugin;
}
#endif

#ifdef BROKEN_NO_FUNCTION
MIMETRA_EXPORT const mimetra_plugin* some_other_function() {
  static const mimetra_plugin plugin = plugin_of(nullptr);
  return &plugin;
}
#endif

#ifdef BROKEN_MISSING_SYMBOL
extern "C" int nobody_defines_this();
const mimetra_plugin* mimetra_get_plugin() {
  static const mimetra_plugin plugin = plugin_of(nullptr);
  return nobody_defines_this() ? &plugin : nullptr;
}
#endif

#ifdef BROKEN_RETURNS_NULL
const mimetra_plugin* mimetra_get_plugin() {
  return nullptr;
}
#endif

#ifdef BROKEN_THROWS
const mimetra_plugin* mimetra_get_plugin() {
  throw std::runtime_error("no licence");
}
#endif

#ifdef BROKEN_TAKEN_NAME
// One of its operations can be used.
const mimetra_plugin* mimetra_get_plugin() {
  static const mimetra_operation taken = operation_named("transfer");
  static const mimetra_operation fine = operation_named("beside-a-taken-name");
  static const mimetra_operation* const operations[] = {&taken, &fine, nullptr};
  static const mimetra_plugin plugin = plugin_of(operations);
  return &plugin;
}
#endif

#ifdef BROKEN_DESCRIPTIONS
const mimetra_plugin* mimetra_get_plugin() {
  static const mimetra_port no_kind = {sizeof no_kind, 99, "sequence", "", 0, 0};
  static const mimetra_port no_size = {0, MIMETRA_SEQUENCE, "sequence", "", 0, 0};
  static const mimetra_port fine = {sizeof fine, MIMETRA_SEQUENCE, "sequence", "", 0, 0};
  static const mimetra_port weights = {
      sizeof weights, MIMETRA_TABLE, "weights", "", MIMETRA_OPTIONAL, 0};
  static const mimetra_port* const of_no_kind[] = {&no_kind, nullptr};
  static const mimetra_port* const of_no_size[] = {&no_size, nullptr};
  static const mimetra_port* const one[] = {&fine, nullptr};
  static const mimetra_port* const twice[] = {&fine, &fine, nullptr};
  static const mimetra_port* const an_option[] = {&weights, nullptr};
  static const char* const phrases[] = {"don't", nullptr};
  static const char* const words[] = {"npy", nullptr};
  constexpr auto kSize = sizeof(mimetra_parameter);
  static const mimetra_parameter common = {kSize, MIMETRA_FLAG, "json", "", nullptr, nullptr, 0,
                                           0,     nullptr,      0,      0};
  static const mimetra_parameter out_of_range = {kSize, MIMETRA_NUMBER, "x", "", "7", nullptr, 0,
                                                 1,     nullptr,        0,   0};
  static const mimetra_parameter frames = {kSize, MIMETRA_FLAG, "frames", "", nullptr, nullptr, 0,
                                           0,     nullptr,      0,        0};
  static const mimetra_parameter format = {kSize, MIMETRA_CHOICE, "format", "", "npy", nullptr, 0,
                                           0,     words,          0,        0};
  static const mimetra_parameter phrase = {kSize, MIMETRA_CHOICE, "phrase", "", nullptr, nullptr, 0,
                                           0,     phrases,        0,        0};
  static const char* const same_words[] = {"npy", "npy", nullptr};
  static const mimetra_parameter again = {kSize, MIMETRA_CHOICE, "again", "", nullptr, nullptr, 0,
                                          0,     same_words,     0,       0};
  static const mimetra_parameter nothing = {
      kSize, MIMETRA_CHOICE, "nothing", "", nullptr, nullptr, 0, 0, nullptr, 0, 0};
  static const mimetra_parameter* const of_again[] = {&again, nullptr};
  static const mimetra_parameter* const of_nothing[] = {&nothing, nullptr};
  static const mimetra_parameter* const of_common[] = {&common, nullptr};
  static const mimetra_parameter* const of_out_of_range[] = {&out_of_range, nullptr};
  static const mimetra_parameter* const of_frames[] = {&frames, nullptr};
  static const mimetra_parameter* const of_format[] = {&format, nullptr};
  static const mimetra_parameter* const of_phrase[] = {&phrase, nullptr};
  static mimetra_operation all[] = {
      operation_named(nullptr),       operation_named("Has Blanks"), operation_named("no-run"),
      operation_named("no-kind"),     operation_named("no-size"),    operation_named("twice"),
      operation_named("common-name"), operation_named("no-default"), operation_named("of-reading"),
      operation_named("of-writing"),  operation_named("an-option"),  operation_named("phrase"),
      operation_named("no-utf8"),     operation_named("again"),      operation_named("nothing")};
  all[2].run = nullptr;
  all[3].inputs = of_no_kind;
  all[4].inputs = of_no_size;
  all[5].inputs = twice;
  all[6].parameters = of_common;
  all[7].parameters = of_out_of_range;
  all[8].inputs = one;
  all[8].parameters = of_frames;
  all[9].outputs = one;
  all[9].parameters = of_format;
  all[10].inputs = one;
  all[10].outputs = an_option;
  all[11].parameters = of_phrase;
  all[12].summary = "\xff\xfe";
  all[13].parameters = of_again;
  all[14].parameters = of_nothing;
  static const mimetra_operation* operations[std::size(all) + 1] = {};
  for (std::size_t i = 0; i < std::size(all); ++i) operations[i] = &all[i];
  static const mimetra_plugin plugin = plugin_of(operations);
  return &plugin;
}
#endif
