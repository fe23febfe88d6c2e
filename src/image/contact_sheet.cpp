#include "image/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"
#include "image/exr_check.h"
#include "image/png.h"

namespace mote {
namespace {

/// Mean over [x0,x1) of one image row or column: whole pixels and the covered parts of the ends.
template <class Get>
Spectrum mean_over(double x0, double x1, const Get& get)
{
    Spectrum sum(0.0f);
    const int last = static_cast<int>(std::ceil(x1)) - 1;
    for (int i = static_cast<int>(x0); i <= last; ++i) {
        const double covered = std::min(x1, i + 1.0) - std::max(x0, static_cast<double>(i));
        sum += static_cast<float>(covered) * get(i);
    }
    return sum / static_cast<float>(x1 - x0);
}

/// Smaller copy by area averages (in linear light), first along x, then along y.
Buffer2D<Spectrum> scale_down(const Buffer2D<Spectrum>& in, int width, int height)
{
    const double step_x = static_cast<double>(in.width()) / width;
    const double step_y = static_cast<double>(in.height()) / height;
    Buffer2D<Spectrum> narrow(width, in.height());
    for (int y = 0; y < in.height(); ++y) {
        for (int x = 0; x < width; ++x) {
            const double end = std::min<double>((x + 1) * step_x, in.width());
            narrow.at(x, y) = mean_over(x * step_x, end, [&](int i) { return in.at(i, y); });
        }
    }
    Buffer2D<Spectrum> out(width, height);
    for (int y = 0; y < height; ++y) {
        const double end = std::min<double>((y + 1) * step_y, in.height());
        for (int x = 0; x < width; ++x) {
            out.at(x, y) = mean_over(y * step_y, end, [&](int i) { return narrow.at(x, i); });
        }
    }
    return out;
}

/// Where the images go.
struct Layout {
    int columns = 0;
    int rows = 0;
    int cell_width = 0;
    int cell_height = 0;
    int gap = 0;

    [[nodiscard]] int left(int i) const { return gap + (i % columns) * (cell_width + gap); }
    [[nodiscard]] int top(int i) const { return gap + (i / columns) * (cell_height + gap); }
};

Layout make_layout(const ContactSheetParams& params, int count, int image_width, int image_height)
{
    Layout layout;
    layout.columns = std::min(params.columns, count);
    layout.rows = (count + layout.columns - 1) / layout.columns;
    layout.gap = params.gap;
    layout.cell_width = std::min(image_width, params.cell_width);
    const double scale = static_cast<double>(layout.cell_width) / image_width;
    layout.cell_height = std::max(1, static_cast<int>(std::lround(image_height * scale)));
    return layout;
}

Buffer2D<Spectrum> make_sheet(const Layout& layout)
{
    const int64_t width = int64_t{layout.columns} * (layout.cell_width + layout.gap) + layout.gap;
    const int64_t height = int64_t{layout.rows} * (layout.cell_height + layout.gap) + layout.gap;
    if (width > max_image_pixels / height) {
        throw Error(ExitCode::Input, "contact sheet: too large; lower the cell width");
    }
    return {static_cast<int>(width), static_cast<int>(height), Spectrum(0.01f)};
}

void check_same_size(const Buffer2D<Spectrum>& image, const std::string& path,
                     const Buffer2D<Spectrum>& first, const std::string& first_path)
{
    if (image.width() == first.width() && image.height() == first.height()) return;
    throw Error(ExitCode::Input,
                fmt::format("contact sheet: \"{}\" is {} x {} pixels but \"{}\" is {} x {}; give "
                            "images of one size",
                            printable(path, 1000), image.width(), image.height(),
                            printable(first_path, 1000), first.width(), first.height()));
}

}  // namespace

void make_contact_sheet(const std::vector<std::string>& image_paths,
                        const ContactSheetParams& params, const std::string& out_path)
{
    if (image_paths.empty()) throw Error(ExitCode::Input, "contact sheet: no images given");
    if (params.columns < 1 || params.cell_width < 1 || params.gap < 0) {
        throw Error(ExitCode::Input, "contact sheet: columns and width must be at least 1");
    }
    const Buffer2D<Spectrum> first = read_png(image_paths[0]);
    const int count = static_cast<int>(image_paths.size());
    const Layout layout = make_layout(params, count, first.width(), first.height());
    Buffer2D<Spectrum> sheet = make_sheet(layout);
    for (int i = 0; i < count; ++i) {
        const std::string& path = image_paths[static_cast<size_t>(i)];
        const Buffer2D<Spectrum> image = i == 0 ? first : read_png(path);
        check_same_size(image, path, first, image_paths[0]);
        const Buffer2D<Spectrum> cell = scale_down(image, layout.cell_width, layout.cell_height);
        for (int y = 0; y < cell.height(); ++y) {
            for (int x = 0; x < cell.width(); ++x) {
                sheet.at(layout.left(i) + x, layout.top(i) + y) = cell.at(x, y);
            }
        }
    }
    write_png(out_path, sheet, {0.0f, ViewTransform::Srgb});
}

}  // namespace mote
