#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "plugins/c/mimetra.h"
#include "plugins/c/shown_arrays.h"
#include "toolkit/operations/data.h"

namespace mimetra {

/// A value that never changes, with its arrays and its JSON, which are made when somebody asks.
class Value {
 public:
  explicit Value(NamedData named) : named_(std::move(named)) {}

  const NamedData& named() const { return named_; }
  mimetra_kind kind() const {
    return static_cast<mimetra_kind>(named_.data.index()) + MIMETRA_SEQUENCE;
  }
  /// May be called from several threads.
  const ShownArrays& arrays() const;
  const std::string& json() const;

 private:
  NamedData named_;
  mutable std::mutex mutex_;
  mutable std::optional<ShownArrays> arrays_;
  mutable std::optional<std::string> json_;
};

/// A value as JSON: regions, tables and fits as their files hold it, others by their arrays.
std::string json_of(const Value& value);

}  // namespace mimetra

/// What the header calls a value: one of any number of handles to it.
struct mimetra_data {
  std::shared_ptr<const mimetra::Value> value;
};
