#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>
#include <ImathVec.h>

#include "importers/shared/scene_importer.h"

namespace abbe::importers::pbrt {

/// A word, number, bracket or quoted string.
struct Token {
  std::string text;  ///< Without quotes.
  bool quoted = false;
  SourcePosition where;

  /// True if the token is `word`, not quoted.
  [[nodiscard]] bool is(std::string_view word) const { return !quoted && text == word; }
  /// True at the end of an imported file.
  [[nodiscard]] bool ends_import() const { return is(""); }
};

/// The tokens of a file and of the files it includes, without comments. The importer must outlive it.
class Tokens {
 public:
  /// Opens the file. Reports an error if it cannot be read; then `failed()` is true.
  Tokens(const std::filesystem::path& file, SceneImporter& importer);

  /// Nothing at the end of all files, and after an error; `failed()` distinguishes them. Reports a quoted
  /// text without its closing quote.
  [[nodiscard]] std::optional<Token> next();
  /// The token that `next` will return, without consuming it. The reference is valid until the next call.
  [[nodiscard]] const std::optional<Token>& peek();
  /// Continues with another file, and after its end with the current one. No token may have been peeked.
  /// `where` is the position of the directive. Reports an unreadable file, inclusion more than 64 levels deep
  /// and more than 10000 included files; then `failed()` is true.
  void include(const std::filesystem::path& file, const SourcePosition& where);
  /// Like `include`, with a further token at the end of the file (`Token::ends_import`), so that no directive
  /// extends past it.
  void import_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Position of the last token that was read or peeked; at the end of all files, the end of the last one.
  [[nodiscard]] const SourcePosition& end() const { return end_; }
  /// True after an error of this object. No further tokens are read then.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  struct OpenFile {
    std::shared_ptr<const SourceText> source;
    std::size_t at = 0;
    bool imported = false;
  };
  std::optional<Token> read();
  std::optional<Token> read_quoted(OpenFile& file);
  void open(const std::filesystem::path& file);

  SceneImporter& importer_;
  std::vector<OpenFile> files_{};
  std::optional<Token> peeked_{};
  SourcePosition end_{};
  bool failed_ = false;
};

/// Reads `count` numbers after the directive `word`, with or without brackets, and appends them to `to`.
/// Reports other tokens and the end of the file, and returns false.
bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to,
                  SceneImporter& importer);

/// Reads the arguments of the transform directive `word` and updates `to_world`, a matrix for row vectors.
/// LookAt, Translate, Scale, Rotate and ConcatTransform apply to points before the old `to_world`; Identity
/// and Transform replace it. Angles are in degrees. Reports singular matrices, a zero axis or scale factor, a
/// view direction along up, and the errors of `read_numbers`; then returns false and leaves `to_world`
/// unchanged.
bool apply_transform(const Token& word, Tokens& tokens, Imath::M44d& to_world, SceneImporter& importer);

/// A parameter `"type name" [ values ]` of the file. At least one of the two lists of values is empty, unless
/// the type is "spectrum".
struct Parameter {
  std::string type;  ///< One of pbrt's types, such as "float" or "rgb".
  std::string name;
  std::vector<double> numbers;     ///< Values that are numbers.
  std::vector<std::string> texts;  ///< Quoted strings, or true and false.
  SourcePosition where;
  mutable bool used = false;  ///< True once it has been read or ignored.
  OwnedReservation memory{};  ///< Memory of the parameter; each copy reserves as much.
};

/// The parameters of one directive. Reading one reports its errors to the importer, which must outlive them.
class Parameters {
 public:
  /// No parameters; without an importer there must be no notes and errors.
  Parameters() = default;
  explicit Parameters(SceneImporter& importer) : importer_(&importer) {}
  /// Reads the parameters that follow, up to the first token that is not quoted. Returns nothing, after
  /// reporting an error, for a parameter without type, name or values, an unknown type, or values of a wrong
  /// type or count.
  [[nodiscard]] static std::optional<Parameters> read(Tokens& tokens, SceneImporter& importer);
  /// Adds the parameters of `defaults` whose names are absent.
  void add_defaults(const Parameters& defaults);

  /// The first parameter called `name`, which is marked as used; nullptr, without an error, if there is none.
  /// Its type must be one of `types`. Reports another type and returns nullptr.
  [[nodiscard]] const Parameter* find(std::string_view name, std::initializer_list<const char*> types) const;
  /// True if there is a parameter called `name`, of any type. Does not mark it as used.
  [[nodiscard]] bool has(std::string_view name) const;
  // Parameters with a single value; `fallback` if absent. Several values and another type are reported, and
  // `fallback` is returned.
  /// A "float".
  [[nodiscard]] double number(std::string_view name, double fallback) const;
  /// An "integer", clamped to [-1e9, 1e9].
  [[nodiscard]] int integer(std::string_view name, int fallback) const;
  [[nodiscard]] bool boolean(std::string_view name, bool fallback) const;
  /// A "string", or the name of a "texture".
  [[nodiscard]] std::string text(std::string_view name, const std::string& fallback) const;
  /// A "point3", "point", "vector3" or "vector" of three numbers.
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& fallback) const;
  /// All numbers of a parameter of numbers, points, vectors or normals; empty if absent. Reports another type
  /// and returns an empty list.
  [[nodiscard]] std::vector<double> numbers(std::string_view name) const;

  /// Marks the parameters called `names`, which have no effect in Abbe, as used. Absent ones are no error.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every parameter that is not marked as used as dropped. `of` names their directive in the notes.
  void note_unused(const std::string& of) const;
  [[nodiscard]] const std::vector<Parameter>& all() const { return list_; }
  [[nodiscard]] SceneImporter& importer() const { return *importer_; }

 private:
  [[nodiscard]] const Parameter* single(std::string_view name, std::initializer_list<const char*> types,
                                        std::size_t count) const;

  SceneImporter* importer_ = nullptr;
  std::vector<Parameter> list_{};
};

/// A directive with its type, such as "diffuse", and its parameters.
struct Directive {
  std::string type;
  Parameters parameters{};
  SourcePosition where{};

  /// Notes an approximated or dropped property of the directive.
  void note(const std::string& text) const { parameters.importer().note(where, text); }
  /// Reports an error at the directive; the result is nothing.
  std::nullopt_t fail(std::string what) const { return parameters.importer().fail(where, std::move(what)); }
};

}  // namespace abbe::importers::pbrt
