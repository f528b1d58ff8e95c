// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/line_plot.h"

#include <limits>

#include "support/expect.h"

namespace osteon::metrics {
namespace {

using testing::HasSubstr;

LinePlot plot() {
  return {"Height & width", {"size", 0.0, 10.0}, {"%", 0.0, 100.0}, {{"tall", {{0, 0}, {10, 100}}}, {"wide", {{0, 100}, {10, 99}}}}};
}

TEST(LinePlot, draws_points_where_they_belong) {
  const std::string svg = to_svg(plot());
  EXPECT_THAT(svg, HasSubstr("points=\"64.0,344.0 490.0,40.0 \""));  // from the left lower corner to the right upper one
}

TEST(LinePlot, names_everything_and_escapes_it) {
  const std::string svg = to_svg(plot());
  for (const char* text : {">Height &amp; width<", ">size<", ">%<", ">tall<", ">wide<", ">100<"}) EXPECT_THAT(svg, HasSubstr(text));
}

TEST(LinePlot, leaves_out_what_is_not_a_number) {
  LinePlot with_gap = plot();
  with_gap.lines[0].points = {{0, 0}, {5, std::numeric_limits<double>::quiet_NaN()}, {10, 100}};
  EXPECT_EQ(to_svg(with_gap), to_svg(plot()));
}

TEST(LinePlot, axes_that_follow_the_lines_end_at_round_numbers) {
  const std::string svg = to_svg({"", {"x"}, {"y"}, {{"a", {{0.3, 17}, {2.8, 41}}}}});
  for (const char* text : {">0<", ">3<", ">15<", ">45<"}) EXPECT_THAT(svg, HasSubstr(text));
}

TEST(LinePlot, a_file_that_cannot_be_written_is_named) {
  EXPECT_THAT(test::error_of([] { save_svg("/nowhere/a.svg", plot()); }), HasSubstr("/nowhere/a.svg"));
}

}  // namespace
}  // namespace osteon::metrics
