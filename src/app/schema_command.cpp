#include <fmt/format.h>

#include "app/commands.h"
#include "scene/scene_io.h"

namespace mote {

void run_schema(const SchemaOptions& options)
{
    fmt::print("{}", options.markdown ? scene_reference_markdown() : scene_schema_json());
}

}  // namespace mote
