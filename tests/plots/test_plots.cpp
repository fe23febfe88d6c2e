#include <limits>
#include <regex>

#include <gtest/gtest.h>

#include "plots/log_plot.h"
#include "plots/page.h"
#include "plots/svg.h"

namespace mote {
namespace {

/// Centres of the marks, in order.
std::vector<std::pair<double, double>> marks_of(const std::string& svg)
{
    std::vector<std::pair<double, double>> marks;
    const std::regex circle("cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it) {
        marks.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
    }
    return marks;
}

}  // namespace

TEST(LogPlot, PowersLieOnLines)
{
    // y = 10 / x: equal steps to the right and down.
    const std::vector<LogSeries> series{{"a", {1.0, 10.0, 100.0}, {10.0, 1.0, 0.1}, false}};
    const auto marks = marks_of(log_plot({"title", "x", "y", 0.0}, series));
    ASSERT_EQ(marks.size(), 3u);
    EXPECT_NEAR(marks[1].first - marks[0].first, marks[2].first - marks[1].first, 0.2);
    EXPECT_NEAR(marks[1].second - marks[0].second, marks[2].second - marks[1].second, 0.2);
    EXPECT_GT(marks[1].first, marks[0].first);
    EXPECT_GT(marks[1].second, marks[0].second);  // down
}

TEST(LogPlot, LeavesOutWhatHasNoLogarithm)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<LogSeries> series{
        {"a", {1.0, 0.0, 2.0, 3.0, 4.0}, {nan, 1.0, -1.0, infinity, 2.0}, true}};
    const std::string svg = log_plot({"", "", "", 1.0}, series);
    EXPECT_EQ(marks_of(svg).size(), 1u);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_EQ(log_plot({"", "", "", 0.0}, {}).find("nan"), std::string::npos);
}

TEST(NamedBars, AreAsLongAsTheirValues)
{
    const std::vector<std::string> names{"a<b", "c"};
    const std::vector<double> values{1.0, 4.0};
    const std::string svg = named_bars("title", names, values, 1.0);
    EXPECT_NE(svg.find("a&lt;b"), std::string::npos);
    std::vector<double> widths;
    const std::regex bar("<rect [^>]*width=\"([0-9.]+)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), bar), end; it != end; ++it) {
        widths.push_back(std::stod((*it)[1]));
    }
    ASSERT_EQ(widths.size(), 2u);
    EXPECT_NEAR(widths[1] / widths[0], 4.0, 0.01);
}

TEST(Page, KeepsLinesAndEscapesText)
{
    EXPECT_EQ(preformatted("a <\nb\n"), "<pre>a &lt;\nb\n</pre>\n");
    EXPECT_NE(page_begin("a & b").find("<title>a &amp; b</title>"), std::string::npos);
    EXPECT_NE(svg_file("<svg width=\"1\"></svg>").find("xmlns="), std::string::npos);
}

}  // namespace mote
