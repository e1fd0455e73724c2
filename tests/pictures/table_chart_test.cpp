#include "toolkit/pictures/table_chart.h"

#include <gmock/gmock.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Table errors_by_share() {
  Table table{{"share", "error", "seconds"},
              {{0.1, 4.0, 1.0}, {0.2, 2.0, 1.0}, {0.1, 3.0, 1.0}, {0.3, std::nullopt, 1.0}}};
  table.word_column = "by";
  table.words = {"one", "one", "other", "other"};
  table.picture = {"share", "error", "Errors", "the share", "the error"};
  return table;
}

TEST(TableChart, HasALineForEachWordWithoutEmptyCells) {
  const Chart chart = chart_of(errors_by_share());
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].name, "one");
  EXPECT_THAT(chart.series[0].x, ElementsAre(0.1, 0.2));
  EXPECT_THAT(chart.series[0].y, ElementsAre(4, 2));
  EXPECT_EQ(chart.series[1].name, "other");
  EXPECT_THAT(chart.series[1].x, ElementsAre(0.1));
  EXPECT_EQ(chart.title, "Errors");
  EXPECT_EQ(chart.y.label, "the error");
}

TEST(TableChart, ShowsAllColumnsAgainstTheFirst) {
  const Chart chart = chart_of(Table{{"time", "a", "b"}, {{0.0, 1.0, 2.0}, {1.0, 3.0, 4.0}}});
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[1].name, "b");
  EXPECT_THAT(chart.series[1].x, ElementsAre(0, 1));
  EXPECT_THAT(chart.series[1].y, ElementsAre(2, 4));
  EXPECT_EQ(chart.x.label, "time");
}

TEST(TableChart, IsLogarithmicWhereItSpansMoreThanAPowerOfTen) {
  Table table = errors_by_share();
  EXPECT_EQ(chart_of(table).y.scale, ChartScale::linear);
  table.rows[0][1] = 40;
  EXPECT_EQ(chart_of(table).y.scale, ChartScale::logarithmic);
  table.rows[1][1] = 0;
  EXPECT_EQ(chart_of(table).y.scale, ChartScale::linear);
}

TEST(TableChart, RefusesATableWithNothingToShow) {
  EXPECT_THAT(
      [] {
        chart_of(Table{{"time", "a"}, {{0.0, std::nullopt}}});
      },
      ThrowsMessage<MismatchError>(HasSubstr("no numbers to draw")));
}

}  // namespace
}  // namespace mimetra
