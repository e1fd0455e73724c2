#include "tests/bench/report.h"

#include <cstdarg>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace mimetra::bench {
namespace {

using Json = nlohmann::ordered_json;

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  char text[256];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

std::string milliseconds(double seconds) {
  const double ms = 1e3 * seconds;
  return formatted(ms < 1 ? "%.4f" : ms < 100 ? "%.2f" : "%.0f", ms);
}

bool has_floor(const Row& row) {
  return row.work.flops > 0 || row.work.bytes > 0;
}

/// What a time means to a user: a share for each piece, a rate, or the memory of a command.
std::string rate_text(const Row& row) {
  const double seconds = row.median();
  if (row.rate.pieces > 0) {
    return milliseconds(seconds / row.rate.pieces) + " ms/" + row.rate.piece;
  }
  if (row.rate.bytes > 0) return formatted("%.2f GB/s", 1e-9 * row.rate.bytes / seconds);
  if (row.peak_bytes > 0) return formatted("peak %.0f MB", 1e-6 * row.peak_bytes);
  if (row.work.flops > 1e9) return formatted("%.1f GFLOP", 1e-9 * row.work.flops);
  return "";
}

std::string line_of(const Row& row, const Limits& limits) {
  const double floor = floor_seconds(row.work, limits);
  const std::string floor_text = has_floor(row) ? milliseconds(floor) : "";
  const std::string multiple = has_floor(row) ? formatted("%.1f", row.median() / floor) : "";
  return formatted("%-51s %-31s %10s %10s %8s  %s\n", row.what.c_str(), row.size.text().c_str(),
                   milliseconds(row.median()).c_str(), floor_text.c_str(), multiple.c_str(),
                   rate_text(row).c_str());
}

/// Others' work lengthens times, and hides a part of what the machine can do.
std::string load_line(const Machine& machine) {
  constexpr double kQuiet = 0.3;
  if (machine.load < kQuiet) return "";
  return formatted(
      "the machine was busy (load %.1f before the run): neither times nor multiples "
      "are its own; run again when it is quiet\n",
      machine.load);
}

std::string machine_lines(const Results& results) {
  const Machine& machine = results.settings.machine;
  const auto rates = [](const char* when, const Limits& limits) {
    return formatted("%s: %.1f GFLOP/s in products of matrices, %.1f GB/s read\n", when,
                     1e-9 * limits.flops, 1e-9 * limits.bytes);
  };
  return formatted("%s, %d threads, %.0f MB of last-level cache\n", machine.processor.c_str(),
                   machine.threads, machine.cache_bytes / (1 << 20)) +
         rates("limits at the start", results.at_start) +
         rates("limits at the end", results.at_end) + load_line(machine);
}

Json json_of(const Limits& limits) {
  return {{"flops_per_second", limits.flops}, {"bytes_per_second", limits.bytes}};
}

Json json_of(const Row& row, const Limits& limits) {
  Json json = {{"group", row.group},
               {"what", row.what},
               {"subject", row.size.subject},
               {"frames", row.size.frames},
               {"vertices", row.size.vertices}};
  if (row.size.count > 0) json[row.size.count_name] = row.size.count;
  json["seconds"] = row.seconds;
  json["median_seconds"] = row.median();
  if (has_floor(row)) {
    const double floor = floor_seconds(row.work, limits);
    json["flops"] = row.work.flops;
    json["bytes"] = row.work.bytes;
    json["floor_seconds"] = floor;
    json["multiple_of_floor"] = row.median() / floor;
  }
  if (row.rate.pieces > 0) json["pieces"] = row.rate.pieces;
  if (row.rate.bytes > 0) json["file_bytes"] = row.rate.bytes;
  if (row.peak_bytes > 0) json["peak_bytes"] = row.peak_bytes;
  return json;
}

}  // namespace

std::vector<Comparison> compared(const std::vector<Row>& rows, const std::string& own,
                                 const std::string& other) {
  std::vector<Comparison> comparisons;
  for (const Row& a : rows) {
    if (a.what != own) continue;
    for (const Row& b : rows) {
      if (b.what != other || b.size.text() != a.size.text()) continue;
      const double ratio = b.median() / a.median();
      comparisons.push_back({formatted("%s, %s: %s ms; %s: %s ms, %.1f times as long", own.c_str(),
                                       a.size.text().c_str(), milliseconds(a.median()).c_str(),
                                       other.c_str(), milliseconds(b.median()).c_str(), ratio),
                             ratio});
    }
  }
  return comparisons;
}

std::string table_of(const Results& results) {
  std::string text = machine_lines(results);
  text +=
      "floor: the larger of arithmetic / product rate and bytes / read rate, of all "
      "threads, by the better limits\n";
  std::string group;
  for (const Row& row : results.rows) {
    if (row.group != group) {
      group = row.group;
      text += '\n' + formatted("%-51s %-31s %10s %10s %8s\n", group.c_str(), "size", "median ms",
                               "floor ms", "multiple");
    }
    text += line_of(row, results.limits());
  }
  text += "\ncompared in this run\n";
  for (const Comparison& comparison : results.comparisons) text += comparison.text + '\n';
  for (const std::string& note : results.notes) text += note + '\n';
  text += "\ntime grows with the power\n";
  for (const Growth& growth : results.growths) {
    text += formatted("%.2f of %-9s %s\n", growth.exponent, growth.against.c_str(),
                      growth.what.c_str());
  }
  return text;
}

std::string json_of(const Results& results) {
  Json rows = Json::array(), growths = Json::array(), comparisons = Json::array();
  for (const Row& row : results.rows) rows.push_back(json_of(row, results.limits()));
  for (const Growth& growth : results.growths) {
    growths.push_back({{"what", growth.what},
                       {"against", growth.against},
                       {"sizes", growth.sizes},
                       {"seconds", growth.seconds},
                       {"exponent", growth.exponent}});
  }
  for (const Comparison& comparison : results.comparisons) {
    comparisons.push_back({{"text", comparison.text}, {"ratio", comparison.ratio}});
  }
  const Machine& machine = results.settings.machine;
  return Json{{"machine",
               {{"processor", machine.processor},
                {"threads", machine.threads},
                {"cache_bytes", machine.cache_bytes},
                {"load_before", machine.load}}},
              {"quick", results.settings.quick},
              {"limits_at_start", json_of(results.at_start)},
              {"limits_at_end", json_of(results.at_end)},
              {"limits", json_of(results.limits())},
              {"rows", rows},
              {"growth", growths},
              {"comparisons", comparisons},
              {"notes", results.notes}}
             .dump(2) +
         '\n';
}

}  // namespace mimetra::bench
