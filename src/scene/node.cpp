#include "scene/node.h"

namespace mote {

const Node* Node::find(std::string_view name) const
{
    if (kind != Kind::Table) return nullptr;
    for (const Node& child : children) {
        if (child.key == name) return &child;
    }
    return nullptr;
}

const char* kind_name(Node::Kind kind)
{
    switch (kind) {
        case Node::Kind::Null:
            return "null";
        case Node::Kind::Bool:
            return "true or false";
        case Node::Kind::Integer:
        case Node::Kind::Float:
            return "a number";
        case Node::Kind::String:
            return "text";
        case Node::Kind::Date:
            return "a date";
        case Node::Kind::Array:
            return "a list";
        case Node::Kind::Table:
            return "a table";
    }
    return "";
}

}  // namespace mote
