#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/base/parameter_table.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/yaml_node.hpp"

namespace downwash::problems {

/// Fills a model from YAML trees along its parameter table and remembers where every key stands.
/// Made for Problem, SpaceProblem and Campaign.
template <class Model>
class TreeReader {
 public:
    /// @pre the table outlives this reader
    explicit TreeReader(const ParameterTable<Model>& table) : table_(table) {}

    /// Reads a file, and those that it refers to. Errors are collected, never thrown.
    /// @param group key of the group that the file holds ("robot"); empty for the whole model
    void read(const std::filesystem::path& file, const std::string& group = "") { read_document(file, group, {}); }
    /// Reads the text of a file of the whole model. @param file names it, and is what its paths are relative to
    void read_text(const std::string& text, const std::filesystem::path& file) { read_text(text, file, ""); }

    /// From now on leaves out keys that have no meaning beside the others, which are errors otherwise.
    void leave_out_inapplicable() { leaves_out_inapplicable_ = true; }

    /// From now on a group that files must have, and what must be in it, may be missing. @param path "robot.controller"
    void may_lack(std::string path) { may_lack_ = std::move(path); }

    [[nodiscard]] const Model& model() const noexcept { return model_; }
    void adjust(const std::function<void(Model&)>& change) { change(model_); }
    /// Keys of which the model has no trustworthy value.
    [[nodiscard]] const WrongKeys& wrong_keys() const noexcept { return wrong_; }
    /// More errors are not worth reading.
    [[nodiscard]] bool is_full() const noexcept;
    /// Adds errors that were found later, each at its key or the nearest key around it.
    void add(const std::vector<KeyError>& errors);
    /// All errors, ordered by file and place; every call gives the same.
    [[nodiscard]] std::vector<LocatedError> errors() const;
    /// Remarks on keys, each at its key or the nearest key around it; ordered like errors.
    [[nodiscard]] std::vector<LocatedError> placed(const std::vector<KeyError>& remarks);
    /// Keys that were read under a former name, ordered like errors.
    [[nodiscard]] std::vector<LocatedError> outdated_keys() const { return located(outdated_); }

 private:
    struct Place {
        std::size_t file;
        Mark mark;
    };
    /// A group that is being read.
    struct Group {
        std::string path;   ///< Path in the table; "path[]" within a list.
        std::string key;    ///< Key in the model.
        std::size_t index;  ///< Index of the list element that it is in.
        Mark mark;
        const YamlNode& node;
        std::map<std::string, std::size_t, std::less<>> entries;  ///< First entry of every name.
        std::vector<std::string> meant;                           ///< Names that misspelt keys stand for.
    };

    void read_document(const std::filesystem::path& file, const std::string& path, const Mark& referred_from);
    void read_text(const std::string& text, const std::filesystem::path& file, const std::string& path,
                   const std::string& referrer = "");
    bool has_supported_schema(const YamlNode& root, const std::string& path);
    bool is_misfit(const YamlNode& node, const std::string& path, const std::string& key);
    void read_keys(Group group);
    void find_entries(Group& group);
    [[nodiscard]] std::string current_name(const Group& group, const YamlNode& key);
    void report_unknown(Group& group, const std::string& name, const Mark& mark);
    [[nodiscard]] static std::optional<std::string> number_before_comma(const Group& group, const Mark& mark);
    [[nodiscard]] bool is_undecided(const Group& group, const Parameter<Model>& parameter) const;
    [[nodiscard]] bool is_required(const Parameter<Model>& parameter) const;
    void check_alternatives(const Group& group);
    void read_parameter(const Group& group, const Parameter<Model>& parameter);
    void read_group(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key,
                    const Mark& key_mark, std::size_t index);
    void read_list(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key, std::size_t index);
    void read_single(const Parameter<Model>& parameter, const YamlNode& node, const std::string& key,
                     std::size_t index);

    [[nodiscard]] std::filesystem::path path_from_here(const std::string& path) const;
    /// Records an error of a key; its value is not trusted from now on.
    void report(const std::string& key, const Mark& mark, const std::string& message);
    void report(const Mark& mark, const std::string& message);
    [[nodiscard]] std::string shown(const std::string& key) const;
    [[nodiscard]] Place place_of(std::string_view key) const;

    const ParameterTable<Model>& table_;
    Model model_;
    WrongKeys wrong_;
    struct File {
        std::filesystem::path path;
        std::string root;  ///< Key of the group that the file is.
    };
    std::vector<File> files_;
    bool leaves_out_inapplicable_ = false;
    std::optional<std::string> may_lack_;
    std::size_t file_ = 0;  ///< The file that is read now.
    std::map<std::string, Place, std::less<>> places_;
    struct Found {
        Place place;
        std::string message;
    };
    [[nodiscard]] std::vector<LocatedError> located(std::vector<Found> findings) const;
    std::vector<Found> found_;
    std::vector<Found> outdated_;
};

}  // namespace downwash::problems
