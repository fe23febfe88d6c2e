#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "image/contact_sheet.h"

namespace mote {

void run_sheet(const SheetOptions& options)
{
    if (std::filesystem::path(options.output).extension() != ".png") {
        throw Error(ExitCode::Usage,
                    fmt::format("the sheet \"{}\" must end in .png; it comes before the images",
                                printable(options.output)));
    }
    ContactSheetParams params;
    const auto near_square = std::ceil(std::sqrt(static_cast<double>(options.inputs.size())));
    params.columns = options.columns > 0 ? options.columns : static_cast<int>(near_square);
    make_contact_sheet(options.inputs, params, options.output);
}

}  // namespace mote
