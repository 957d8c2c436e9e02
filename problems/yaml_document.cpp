#include "downwash/problems/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "downwash/problems/text_checks.hpp"

namespace downwash::problems {
namespace {

Mark mark_of(const YAML::Mark& mark) {
    return mark.is_null() ? Mark{} : Mark{mark.line + 1, mark.column + 1};
}

/// Builds the tree out of the parser's events.
class TreeBuilder : public YAML::EventHandler {
 public:
    /// @param max_events more than a text of this size can have: the parser runs in circles
    explicit TreeBuilder(std::size_t max_events) : events_left_(max_events) {}

    [[nodiscard]] YamlNode::Pointer root() const { return root_; }

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(finished(new_node(YamlNode::Kind::null, mark), anchor));
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        count_event(mark);
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end()) {
            throw YamlError(mark_of(mark), "an alias refers to a value that it is part of: write the value out");
        }
        if (static_cast<int>(open_.size()) + found->second->depth > deepest_nesting) {
            refuse_depth(mark);
        }
        add(found->second);
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        refuse_tag(mark, tag);
        auto node = new_node(YamlNode::Kind::scalar, mark);
        node->text = value;
        node->is_quoted = tag == "!";
        add(finished(std::move(node), anchor));
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::list, mark, tag, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::map, mark, tag, anchor);
    }
    void OnMapEnd() override { close(); }

 private:
    struct Open {
        std::shared_ptr<YamlNode> node;
        YAML::anchor_t anchor;
        YamlNode::Pointer key;  ///< Key of a map whose value comes next.
    };

    void count_event(const YAML::Mark& mark) {
        if (events_left_ == 0) {
            throw YamlError(mark_of(mark), "cannot be read as YAML: expected keys and values");
        }
        --events_left_;
    }

    static void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
        if (!tag.empty() && tag != "?" && tag != "!") {
            throw YamlError(mark_of(mark), "a tag (!...) is not understood here: remove it");
        }
    }
    [[noreturn]] static void refuse_depth(const YAML::Mark& mark) {
        throw YamlError(mark_of(mark),
                        "is nested deeper than " + std::to_string(deepest_nesting) + " levels: expected a problem");
    }

    std::shared_ptr<YamlNode> new_node(YamlNode::Kind kind, const YAML::Mark& mark) {
        count_event(mark);
        auto node = std::make_shared<YamlNode>();
        node->kind = kind;
        node->mark = mark_of(mark);
        return node;
    }

    YamlNode::Pointer finished(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
        if (anchor != 0) {
            anchors_[anchor] = node;
        }
        return node;
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
        refuse_tag(mark, tag);
        if (static_cast<int>(open_.size()) >= deepest_nesting) {
            refuse_depth(mark);
        }
        open_.push_back({new_node(kind, mark), anchor, nullptr});
    }

    void close() {
        const Open done = open_.back();
        open_.pop_back();
        add(finished(done.node, done.anchor));
    }

    void add(const YamlNode::Pointer& node) {
        if (open_.empty()) {
            root_ = node;
            return;
        }
        Open& parent = open_.back();
        parent.node->depth = std::max(parent.node->depth, node->depth + 1);
        if (parent.node->kind == YamlNode::Kind::list) {
            parent.node->items.push_back(node);
        } else if (!parent.key) {
            parent.key = node;
        } else {
            parent.node->entries.emplace_back(std::move(parent.key), node);
            parent.key = nullptr;
        }
    }

    std::size_t events_left_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, YamlNode::Pointer> anchors_;
    YamlNode::Pointer root_;
};

/// A text in which no line ends with CR alone, which YAML allows and the library does not know.
std::string with_line_feeds(std::string text) {
    for (std::size_t at = text.find('\r'); at != std::string::npos; at = text.find('\r', at + 1)) {
        if (at + 1 == text.size() || text[at + 1] != '\n') {
            text[at] = '\n';
        }
    }
    return text;
}

}  // namespace

YamlNode::Pointer parse_yaml(const std::string& bytes) {
    const std::string text = with_line_feeds(bytes);
    check_text(text);
    // The library takes a quote that is never closed for closed when the text ends in a line break: let it end
    // otherwise.
    std::istringstream stream(text + "\n# end");
    try {
        YAML::Parser parser(stream);
        TreeBuilder builder(4 * text.size() + 16);
        if (!parser.HandleNextDocument(builder) || builder.root()->kind == YamlNode::Kind::null) {
            throw YamlError({}, "is empty: expected a YAML document with keys");
        }
        TreeBuilder rest(4 * text.size() + 16);
        if (parser.HandleNextDocument(rest)) {
            throw YamlError(rest.root() ? rest.root()->mark : Mark{}, "a second document begins: expected only one");
        }
        return builder.root();
    } catch (const YAML::Exception& error) {
        throw YamlError(mark_of(error.mark),
                        "cannot be read as YAML (" + error.msg +
                            "): expected 'key: value' with matching brackets, quotes and indentation");
    }
}

}  // namespace downwash::problems
