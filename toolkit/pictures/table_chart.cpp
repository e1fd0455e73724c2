#include "toolkit/pictures/table_chart.h"

#include <algorithm>
#include <utility>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

std::size_t column_of(const Table& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name);
  if (found == table.columns.end()) throw MismatchError("the table has no column " + name);
  return static_cast<std::size_t>(found - table.columns.begin());
}

/// Rows with one word, or all rows if `word` is null.
ChartSeries line_of(const Table& table, std::size_t x, std::size_t y, const std::string* word) {
  ChartSeries line;
  line.name = word ? *word : table.columns[y];
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto& cells = table.rows[row];
    if ((word && table.words[row] != *word) || !cells[x] || !cells[y]) continue;
    line.x.push_back(*cells[x]);
    line.y.push_back(*cells[y]);
  }
  return line;
}

/// Distinct words in order of appearance.
std::vector<std::string> words_in(const Table& table) {
  std::vector<std::string> words;
  for (const std::string& word : table.words) {
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return words;
}

std::vector<ChartSeries> lines_of(const Table& table) {
  std::vector<ChartSeries> lines;
  if (!table.picture) {
    for (std::size_t y = 1; y < table.columns.size(); ++y) {
      lines.push_back(line_of(table, 0, y, nullptr));
      lines.back().marked = false;
    }
    return lines;
  }
  const std::size_t x = column_of(table, table.picture->x), y = column_of(table, table.picture->y);
  if (table.word_column.empty()) return {line_of(table, x, y, nullptr)};
  for (const std::string& word : words_in(table)) {
    lines.push_back(line_of(table, x, y, &word));
    if (word.empty()) lines.back().name = table.picture->without_word;
  }
  return lines;
}

/// A logarithmic scale has ticks if numbers span more than this factor.
constexpr double kManyTimes = 10;

bool spans_magnitudes(const std::vector<ChartSeries>& lines) {
  double least = lines.front().y.front(), most = least;
  for (const ChartSeries& line : lines) {
    least = std::min(least, std::ranges::min(line.y));
    most = std::max(most, std::ranges::max(line.y));
  }
  return least > 0 && most > kManyTimes * least;
}

}  // namespace

Chart chart_of(const Table& table) {
  Chart chart;
  chart.series = lines_of(table);
  std::erase_if(chart.series, [](const ChartSeries& line) { return line.x.empty(); });
  if (chart.series.empty()) throw MismatchError("the table has no numbers to draw");
  if (!table.picture) {
    chart.x.label = table.columns.front();
    return chart;
  }
  chart.title = table.picture->title;
  chart.x.label = table.picture->x_label;
  chart.y.label = table.picture->y_label;
  if (spans_magnitudes(chart.series)) chart.y.scale = ChartScale::logarithmic;
  return chart;
}

}  // namespace mimetra
