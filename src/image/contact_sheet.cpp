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

}  // namespace

void make_contact_sheet(const std::vector<std::string>& image_paths,
                        const ContactSheetParams& params, const std::string& out_path)
{
    if (image_paths.empty()) throw Error(ExitCode::Input, "contact sheet: no images given");
    if (params.columns < 1 || params.cell_width < 1 || params.gap < 0) {
        throw Error(ExitCode::Input, "contact sheet: columns and width must be at least 1");
    }
    Buffer2D<Spectrum> sheet;
    int full_width = 0, full_height = 0;
    int width = 0, height = 0;
    const int count = static_cast<int>(image_paths.size());
    const int columns = std::min(params.columns, count);
    const int rows = (count + columns - 1) / columns;
    for (int i = 0; i < count; ++i) {
        const std::string& path = image_paths[static_cast<size_t>(i)];
        const Buffer2D<Spectrum> image = read_png(path);
        if (i == 0) {
            full_width = image.width();
            full_height = image.height();
            width = std::min(full_width, params.cell_width);
            height = std::max(1, static_cast<int>(std::lround(static_cast<double>(full_height) *
                                                              width / full_width)));
            const int64_t sheet_width = int64_t{columns} * (width + params.gap) + params.gap;
            const int64_t sheet_height = int64_t{rows} * (height + params.gap) + params.gap;
            if (sheet_width > max_image_pixels / sheet_height) {
                throw Error(ExitCode::Input, "contact sheet: too large; lower the cell width");
            }
            sheet = Buffer2D<Spectrum>(static_cast<int>(sheet_width),
                                       static_cast<int>(sheet_height), Spectrum(0.01f));
        } else if (image.width() != full_width || image.height() != full_height) {
            throw Error(
                ExitCode::Input,
                fmt::format("contact sheet: \"{}\" is {} x {} pixels but \"{}\" is {} x {}; "
                            "give images of one size",
                            printable(path, 1000), image.width(), image.height(),
                            printable(image_paths[0], 1000), full_width, full_height));
        }
        const Buffer2D<Spectrum> cell = scale_down(image, width, height);
        const int left = params.gap + (i % columns) * (width + params.gap);
        const int top = params.gap + (i / columns) * (height + params.gap);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) sheet.at(left + x, top + y) = cell.at(x, y);
        }
    }
    write_png(out_path, sheet, {0.0f, ViewTransform::Srgb});
}

}  // namespace mote
