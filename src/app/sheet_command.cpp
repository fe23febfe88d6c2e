#include <cmath>

#include "app/commands.h"
#include "image/contact_sheet.h"

namespace mote {

void run_sheet(const SheetOptions& options)
{
    ContactSheetParams params;
    const auto near_square = std::ceil(std::sqrt(static_cast<double>(options.inputs.size())));
    params.columns = options.columns > 0 ? options.columns : static_cast<int>(near_square);
    make_contact_sheet(options.inputs, params, options.output);
}

}  // namespace mote
