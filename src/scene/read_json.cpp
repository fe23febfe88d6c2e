#include <cctype>

#include <nlohmann/json.hpp>

#include "core/text.h"
#include "scene/node.h"

namespace mote {
namespace {

/// Line and column of the tokens of a JSON text, which nlohmann-json does not report. The parser
/// calls back once per token in file order; the text up to there is known to be valid, so stepping
/// over a token needs no parser.
class TokenPositions {
  public:
    explicit TokenPositions(std::string_view text) : text_(text)
    {
        if (text.substr(0, 3) == "\xef\xbb\xbf") offset_ = 3;
    }

    /// Position of the next token, which is stepped over.
    SourcePosition take()
    {
        while (offset_ < text_.size() && is_between_tokens(text_[offset_])) step();
        const SourcePosition where{line_, column_, -1};
        if (offset_ >= text_.size()) return where;
        const char first = text_[offset_];
        step();
        if (first == '"') {
            while (offset_ < text_.size() && text_[offset_] != '"') {
                if (text_[offset_] == '\\') step();
                step();
            }
            step();
        } else if (std::string_view("[]{}").find(first) == std::string_view::npos) {
            while (offset_ < text_.size() && is_in_word(text_[offset_])) step();
        }
        return where;
    }

    /// Position of a byte offset at or after the tokens taken so far.
    SourcePosition at(size_t offset)
    {
        while (offset_ < std::min(offset, text_.size())) step();
        return {line_, column_, -1};
    }

  private:
    static bool is_between_tokens(char c)
    {
        return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ':';
    }
    static bool is_in_word(char c)
    {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    }
    void step()
    {
        if (offset_ >= text_.size()) return;
        const char c = text_[offset_++];
        if (c == '\n') {
            ++line_;
            column_ = 1;
        } else if ((static_cast<unsigned char>(c) & 0xc0u) != 0x80u) {
            ++column_;  // code points, as in TOML
        }
    }

    std::string_view text_;
    size_t offset_ = 0;
    int line_ = 1;
    int column_ = 1;
};

/// Builds the node tree from nlohmann's parse events.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit JsonBuilder(std::string_view text) : positions_(text) { stack_.push_back(&root_); }

    bool null() override
    {
        add(Node::Kind::Null);
        return true;
    }
    bool boolean(bool value) override
    {
        add(Node::Kind::Bool).integer = value ? 1 : 0;
        return true;
    }
    bool number_integer(number_integer_t value) override
    {
        add(Node::Kind::Integer).integer = value;
        return true;
    }
    bool number_unsigned(number_unsigned_t value) override
    {
        if (value <= static_cast<number_unsigned_t>(std::numeric_limits<int64_t>::max())) {
            return number_integer(static_cast<number_integer_t>(value));
        }
        return number_float(static_cast<double>(value), "");
    }
    bool number_float(number_float_t value, const string_t&) override
    {
        add(Node::Kind::Float).number = value;
        return true;
    }
    bool string(string_t& value) override
    {
        add(Node::Kind::String).text = value;
        return true;
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(size_t) override
    {
        open(Node::Kind::Table);
        return true;
    }
    bool start_array(size_t) override
    {
        open(Node::Kind::Array);
        return true;
    }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& value) override
    {
        key_where_ = positions_.take();
        key_ = value;
        return true;
    }
    bool parse_error(size_t byte, const std::string&, const nlohmann::detail::exception& e) override
    {
        const std::string_view text = e.what();
        // "[json.exception.parse_error.101] parse error at line 1, column 2: what happened"
        const size_t colon = text.find(": ");
        throw SyntaxError{
            positions_.at(byte > 0 ? byte - 1 : 0),
            printable(colon == std::string_view::npos ? text : text.substr(colon + 2))};
    }

    Node& root() { return root_.children.front(); }

  private:
    Node& add(Node::Kind kind)
    {
        Node& node = stack_.back()->children.emplace_back();
        node.kind = kind;
        node.where = positions_.take();
        node.key = std::move(key_);
        node.key_where = key_where_;
        key_.clear();
        if (++count_ > max_scene_values) throw SyntaxError{node.where, "too many values"};
        return node;
    }
    void open(Node::Kind kind)
    {
        Node& node = add(kind);
        if (stack_.size() > max_scene_depth) throw SyntaxError{node.where, "nested too deeply"};
        stack_.push_back(&node);  // stays valid: only the innermost node's children grow
    }
    bool close()
    {
        (void)positions_.take();
        stack_.pop_back();
        return true;
    }

    TokenPositions positions_;
    Node root_;
    std::vector<Node*> stack_;
    std::string key_;
    SourcePosition key_where_;
    size_t count_ = 0;
};

}  // namespace

Node parse_json(std::string_view text)
{
    JsonBuilder builder(text);
    nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.root());
}

}  // namespace mote
