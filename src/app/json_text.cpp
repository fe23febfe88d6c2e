#include "app/json_text.h"

#include <nlohmann/json.hpp>

namespace mote {

std::string json_quote(std::string_view text)
{
    const nlohmann::json value(text);
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace mote
