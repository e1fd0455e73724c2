#include "plugins/c/interface.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "plugins/c/call_handle.h"
#include "plugins/c/job.h"
#include "plugins/c/make_data.h"
#include "toolkit/operations/option_words.h"

namespace mimetra {

namespace {

constexpr const char* kNoHandle = "the handle is NULL";

mimetra_data* handle(std::shared_ptr<const Value> value) {
  return new mimetra_data{std::move(value)};
}

mimetra_data* handle(NamedData named) {
  return handle(std::make_shared<const Value>(std::move(named)));
}

/// Logs the notes of a new value, except notes that were logged before.
void say_notes(const mimetra_context& context, const NamedData& made,
               const std::vector<std::string>& said) {
  if (!context.log) return;
  for (const std::string& note : made.origin.notes) {
    if (std::ranges::find(said, note) == said.end()) context.log(LogLevel::warning, note);
  }
}

mimetra_status new_context(mimetra_log log, void* user, mimetra_context** context) noexcept {
  return make_context(
      [](OperationTable& table) {
        add_toolkit(table);
        return std::vector<std::string>();
      },
      log, user, context);
}

void free_context(mimetra_context* context) noexcept {
  delete context;
}

const char* message(const mimetra_context* context) noexcept {
  return context ? context->message.c_str() : kNoHandle;
}

mimetra_status set_progress(mimetra_context* context, mimetra_progress progress,
                            void* user) noexcept {
  return guarded(context, [&] {
    Progress called;
    if (progress) called = [progress, user](double share) { return progress(share, user) != 0; };
    context->context = context->context.with_progress(std::move(called));
  });
}

mimetra_status set_threads(mimetra_context* context, int32_t threads) noexcept {
  return guarded(context, [&] {
    if (threads < 0) {
      throw UsageError("threads: expected 0 or more, found " + std::to_string(threads));
    }
    context->context = context->context.with_threads(std::min(threads, kMostThreads));
  });
}

const mimetra_operation* const* operations(const mimetra_context* context) noexcept {
  static const mimetra_operation* const none = nullptr;
  return context ? context->table->list() : &none;
}

const mimetra_operation* find_operation(const mimetra_context* context, const char* name) noexcept {
  return context && name ? context->table->find(name) : nullptr;
}

const mimetra_format* const* formats(const mimetra_context* context) noexcept {
  static const mimetra_format* const none = nullptr;
  return context ? context->table->formats() : &none;
}

mimetra_status operations_json(mimetra_context* context, const char** json) noexcept {
  if (json) *json = nullptr;
  return guarded(context, [&] { *needed(json, "json") = context->table->json().c_str(); });
}

mimetra_status new_data(mimetra_context* context, mimetra_kind kind, const char* name,
                        const mimetra_array* const* arrays, mimetra_data** data) noexcept {
  if (data) *data = nullptr;
  return guarded(context, [&] {
    NamedData made = made_data(kind, name ? name : "", needed(arrays, "arrays"));
    say_notes(*context, made, {});
    *needed(data, "data") = handle(std::move(made));
  });
}

mimetra_status derive_data(mimetra_context* context, const mimetra_data* base,
                           const mimetra_array* const* arrays, mimetra_data** data) noexcept {
  if (data) *data = nullptr;
  return guarded(context, [&] {
    const NamedData& origin = needed(base, "base")->value->named();
    NamedData made = derived_data(origin, needed(arrays, "arrays"));
    say_notes(*context, made, origin.origin.notes);
    *needed(data, "data") = handle(std::move(made));
  });
}

mimetra_status load_data(mimetra_context* context, mimetra_kind kind, const char* text,
                         const char* const* settings, mimetra_data** data) noexcept {
  if (data) *data = nullptr;
  return guarded(context, [&] {
    *needed(data, "data") =
        handle(loaded_data(*context, kind_of(kind), needed(text, "text"), settings));
  });
}

mimetra_status save_data(mimetra_context* context, const mimetra_data* data, const char* path,
                         const char* const* settings) noexcept {
  return guarded(context, [&] {
    write_data(*context, needed(data, "data")->value->named().data, needed(path, "path"), settings);
  });
}

void free_data(mimetra_data* data) noexcept {
  delete data;
}

mimetra_kind data_kind(const mimetra_data* data) noexcept {
  return data ? data->value->kind() : 0;
}

const char* data_name(const mimetra_data* data) noexcept {
  return data ? data->value->named().name.c_str() : "";
}

mimetra_status data_arrays(mimetra_context* context, const mimetra_data* data,
                           const mimetra_array* const** arrays) noexcept {
  if (arrays) *arrays = nullptr;
  return guarded(context,
                 [&] { *needed(arrays, "arrays") = needed(data, "data")->value->arrays().list(); });
}

mimetra_status data_array(mimetra_context* context, const mimetra_data* data, const char* name,
                          const mimetra_array** array) noexcept {
  if (array) *array = nullptr;
  return guarded(context, [&] {
    const Value& value = *needed(data, "data")->value;
    const mimetra_array* found = value.arrays().find(needed(name, "name"));
    if (!found) {
      std::string known;
      for (const mimetra_array& each : value.arrays().arrays()) {
        known += (known.empty() ? "" : ", ") + std::string(each.name);
      }
      throw UsageError("there is no array '" + std::string(name) + "'; there are " + known);
    }
    *needed(array, "array") = found;
  });
}

mimetra_status data_json(mimetra_context* context, const mimetra_data* data,
                         const char** json) noexcept {
  if (json) *json = nullptr;
  return guarded(context,
                 [&] { *needed(json, "json") = needed(data, "data")->value->json().c_str(); });
}

mimetra_status new_call(mimetra_context* context, const char* operation,
                        mimetra_call** call) noexcept {
  if (call) *call = nullptr;
  return guarded(context, [&] {
    *needed(call, "call") =
        std::make_unique<mimetra_call>(*context, needed(operation, "operation")).release();
  });
}

void free_call(mimetra_call* call) noexcept {
  delete call;
}

/// Context that gets the messages about a call's errors.
mimetra_context* context_of(const mimetra_call* call) {
  return call ? &call->context() : nullptr;
}

mimetra_status call_set(mimetra_call* call, const char* parameter, const char* text) noexcept {
  return guarded(context_of(call), [&] { call->set(needed(parameter, "parameter"), text); });
}

mimetra_status call_give(mimetra_call* call, const char* input, const mimetra_data* data) noexcept {
  return guarded(context_of(call),
                 [&] { call->give(needed(input, "input"), needed(data, "data")->value); });
}

mimetra_status call_read(mimetra_call* call, const char* input, const char* text) noexcept {
  return guarded(context_of(call),
                 [&] { call->read(needed(input, "input"), needed(text, "text")); });
}

mimetra_status call_want(mimetra_call* call, const char* output) noexcept {
  return guarded(context_of(call), [&] { call->want(needed(output, "output")); });
}

mimetra_status call_write(mimetra_call* call, const char* output, const char* path,
                          int32_t replace) noexcept {
  return guarded(context_of(call), [&] {
    needed(path, "path");
    if (output) {
      call->write(output, path, replace != 0);
    } else {
      call->write_manifest(path, replace != 0);
    }
  });
}

mimetra_status call_run(mimetra_call* call) noexcept {
  return guarded(context_of(call), [&] { call->run(); });
}

int32_t call_output_count(const mimetra_call* call, const char* output) noexcept {
  return call && output ? static_cast<int32_t>(call->output(output).size()) : 0;
}

mimetra_status call_output(mimetra_call* call, const char* output, int32_t index,
                           mimetra_data** data) noexcept {
  if (data) *data = nullptr;
  return guarded(context_of(call), [&] {
    const auto& values = call->output(needed(output, "output"));
    if (index < 0 || static_cast<std::size_t>(index) >= values.size()) {
      throw UsageError("output '" + std::string(output) + "' has " + std::to_string(values.size()) +
                       " values, there is none of index " + std::to_string(index));
    }
    *needed(data, "data") = handle(values[static_cast<std::size_t>(index)]);
  });
}

const char* call_report(const mimetra_call* call) noexcept {
  return call ? call->report().c_str() : "";
}

const char* call_summary(const mimetra_call* call) noexcept {
  return call ? call->summary().c_str() : "";
}

mimetra_context* job_context(mimetra_job* job) noexcept {
  return job ? &job->context() : nullptr;
}

const mimetra_data* job_input(mimetra_job* job, const char* input, int32_t index) noexcept {
  return job && input ? job->input(input, index) : nullptr;
}

double job_number(mimetra_job* job, const char* parameter) noexcept {
  double number = std::nan("");
  guarded(job_context(job), [&] { number = job->number(needed(parameter, "parameter")); });
  return number;
}

const char* job_text(mimetra_job* job, const char* parameter) noexcept {
  const char* text = nullptr;
  guarded(job_context(job), [&] { text = job->text(needed(parameter, "parameter")); });
  return text;
}

int32_t job_threads(mimetra_job* job) noexcept {
  return job ? job->threads() : 0;
}

int32_t job_wants(mimetra_job* job, const char* output) noexcept {
  return job && output && job->wants(output) ? 1 : 0;
}

mimetra_status job_progress(mimetra_job* job, double share) noexcept {
  return guarded(job_context(job), [&] { job->progress(share); });
}

void job_log(mimetra_job* job, int32_t level, const char* text) noexcept {
  guarded(job_context(job), [&] {
    job->log(level == MIMETRA_INFO ? LogLevel::info : LogLevel::warning, needed(text, "text"));
  });
}

mimetra_status job_fail(mimetra_job* job, mimetra_status status, const char* text) noexcept {
  const mimetra_status kept =
      guarded(job_context(job), [&] { job->fail(needed(text, "message")); });
  return kept == MIMETRA_OK ? status : kept;
}

mimetra_status job_output(mimetra_job* job, const char* output, const mimetra_data* data) noexcept {
  return guarded(job_context(job), [&] {
    job->output(needed(output, "output"), needed(data, "data")->value->named());
  });
}

mimetra_status job_report(mimetra_job* job, const char* json, const char* summary) noexcept {
  return guarded(job_context(job),
                 [&] { job->report(json ? json : "{}", summary ? summary : ""); });
}

}  // namespace

mimetra_status make_context(const std::function<std::vector<std::string>(OperationTable&)>& fill,
                            mimetra_log log, void* user, mimetra_context** context) noexcept {
  if (!context) return MIMETRA_USAGE;
  *context = nullptr;
  try {
    std::vector<std::string> problems;
    auto made = std::make_unique<mimetra_context>();
    made->table = std::make_shared<const DescribedTable>(
        [&](OperationTable& table) { problems = fill(table); });
    if (log) {
      made->log = [log, user](LogLevel level, const std::string& text) {
        log(level == LogLevel::info ? MIMETRA_INFO : MIMETRA_WARNING,
            with_options_spelled(text, spelled_for_library).c_str(), user);
      };
      for (const std::string& problem : problems) made->log(LogLevel::warning, problem);
    }
    *context = made.release();
    return MIMETRA_OK;
  } catch (...) {
    return MIMETRA_FAILED;
  }
}

const mimetra_interface& toolkit_interface() {
  static constexpr mimetra_interface kFunctions = {sizeof(mimetra_interface),
                                                   MIMETRA_INTERFACE_VERSION,
                                                   MIMETRA_VERSION,
                                                   new_context,
                                                   free_context,
                                                   message,
                                                   set_progress,
                                                   set_threads,
                                                   operations,
                                                   find_operation,
                                                   operations_json,
                                                   new_data,
                                                   derive_data,
                                                   load_data,
                                                   save_data,
                                                   free_data,
                                                   data_kind,
                                                   data_name,
                                                   data_arrays,
                                                   data_array,
                                                   data_json,
                                                   new_call,
                                                   free_call,
                                                   call_set,
                                                   call_give,
                                                   call_read,
                                                   call_want,
                                                   call_write,
                                                   call_run,
                                                   call_output_count,
                                                   call_output,
                                                   call_report,
                                                   call_summary,
                                                   job_context,
                                                   job_input,
                                                   job_number,
                                                   job_text,
                                                   job_threads,
                                                   job_wants,
                                                   job_progress,
                                                   job_log,
                                                   job_fail,
                                                   job_output,
                                                   job_report,
                                                   formats};
  return kFunctions;
}

const mimetra_interface* library_interface(uint32_t version,
                                           decltype(mimetra_interface::new_context) new_context) {
  static const mimetra_interface functions = [new_context] {
    mimetra_interface all = toolkit_interface();
    all.new_context = new_context;
    return all;
  }();
  return version == MIMETRA_INTERFACE_VERSION ? &functions : nullptr;
}

}  // namespace mimetra
