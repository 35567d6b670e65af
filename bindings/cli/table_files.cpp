// Landmark files as CSV and as MeshLab's picked points (.pp).
#include <algorithm>
#include <map>

#include "command_error.h"
#include "landmark_files.h"
#include "landmark_text.h"

namespace focal_cli {
namespace {

using Cells = std::map<std::string, std::string>;  // by column or attribute name

Landmark landmark_of(const Cells& cells) {
  const auto cell = [&](const char* name) {
    const auto found = cells.find(name);
    return found == cells.end() ? std::string_view() : std::string_view(found->second);
  };
  Landmark mark;
  mark.name = cell("name");
  mark.status = cell("status");
  if (!cell("confidence").empty()) mark.confidence = number_of(cell("confidence"));
  if (!mark.absent())
    mark.position = Position{number_of(cell("x")), number_of(cell("y")), number_of(cell("z"))};
  return mark;
}

// The columns of a table, from its first line, in lower case; a column "label" serves as the name if there is no column "name".
struct Table {
  char separator = ',';
  std::vector<std::string> columns;
};

std::string column_name(std::string_view cell) {
  std::string name(trimmed(cell));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name;
}

// The separator that makes the most of the line.
Table table_of(std::string_view header) {
  Table table;
  for (const char separator : {',', ';', '\t'}) {
    const std::vector<std::string> cells = split_csv_line(header, separator);
    if (cells.size() <= table.columns.size()) continue;
    table = {separator, {}};
    for (const std::string& cell : cells) table.columns.push_back(column_name(cell));
  }
  auto& columns = table.columns;
  if (std::find(columns.begin(), columns.end(), "name") == columns.end())
    std::replace(columns.begin(), columns.end(), std::string("label"), std::string("name"));
  return table;
}

bool is_number_column(const std::string& name) {
  return name == "x" || name == "y" || name == "z" || name == "confidence";
}

// Spreadsheets write "0,5" where their language does, and then put semicolons between the cells. Elsewhere "1,234" could be either.
std::string with_decimal_point(std::string cell, char separator) {
  const size_t comma = cell.find(',');
  if (comma == std::string::npos || cell.find_first_of(",.", comma + 1) != std::string::npos ||
      cell.find('.') < comma)
    return cell;
  const std::string_view digits = trimmed(std::string_view(cell).substr(comma + 1));
  const std::string_view whole = trimmed(std::string_view(cell).substr(0, comma));
  if (separator != ';' && digits.size() == 3 && whole != "0" && whole != "-0")
    throw CommandError("'" + cell + "' may be a number of thousands or have a decimal comma",
                       "write numbers with a decimal point, or semicolons between the cells");
  cell[comma] = '.';
  return cell;
}

std::string unescaped(std::string_view text) {
  static const std::map<std::string_view, char> entities = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string plain;
  while (!text.empty()) {
    const auto found = entities.find(text.substr(0, text.find(';') + 1));
    const bool entity = text.front() == '&' && found != entities.end();
    plain += entity ? found->second : text.front();
    text.remove_prefix(entity ? found->first.size() : 1);
  }
  return plain;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '&'   ? "&amp;"
            : c == '<' ? "&lt;"
            : c == '>' ? "&gt;"
            : c == '"' ? "&quot;"
                       : std::string(1, c);
  }
  return safe;
}

// The attributes of one element: name="value" or name='value' in any order.
Cells attributes_of(std::string_view element) {
  Cells attributes;
  for (size_t equals; (equals = element.find('=')) != std::string_view::npos;) {
    const std::string_view before = trimmed(element.substr(0, equals));
    const size_t open = element.find_first_of("\"'", equals);
    if (open == std::string_view::npos) break;
    const size_t close = element.find(element[open], open + 1);
    if (close == std::string_view::npos) break;
    const size_t name_start = before.find_last_of(" \t\r\n") + 1;  // npos + 1 is 0
    attributes[std::string(before.substr(name_start))] =
        unescaped(element.substr(open + 1, close - open - 1));
    element.remove_prefix(close + 1);
  }
  return attributes;
}

// Where the element ends: the first '>' outside quotes.
size_t element_end(std::string_view text) {
  char quote = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (quote ? text[i] == quote : text[i] == '"' || text[i] == '\'') quote = quote ? 0 : text[i];
    if (text[i] == '>' && !quote) return i;
  }
  throw CommandError("a <point> is not closed", "check that the file was saved completely");
}

}  // namespace

LandmarkFile parse_csv(std::string_view text) {
  const std::vector<std::string_view> lines = lines_of(text);
  const Table table = lines.empty() ? Table{} : table_of(lines.front());
  LandmarkFile file;
  for (const char* needed : {"name", "x", "y", "z"}) {
    if (std::count(table.columns.begin(), table.columns.end(), needed) != 1) {
      throw CommandError(
          "the first line does not name one column '" + std::string(needed) + "'",
          "begin the file with the line name,x,y,z; semicolons or tabs may stand between them too");
    }
  }
  for (size_t row = 1; row < lines.size(); ++row) {
    const std::vector<std::string> cells = split_csv_line(lines[row], table.separator);
    Cells by_name;
    for (size_t i = 0; i < std::min(cells.size(), table.columns.size()); ++i)
      by_name[table.columns[i]] =
          is_number_column(table.columns[i]) ? with_decimal_point(cells[i], table.separator) : cells[i];
    file.landmarks.push_back(landmark_of(by_name));
  }
  return file;
}

std::string format_csv(const LandmarkFile& file) {
  std::string text = "name,x,y,z,status,confidence\n";
  for (const Landmark& mark : file.landmarks) {
    if (mark.absent()) continue;
    const Position p = position_of(mark);
    text += csv_cell(mark.name) + "," + text_of(p[0]) + "," + text_of(p[1]) + "," + text_of(p[2]) + "," +
            mark.status + "," + (mark.confidence ? text_of(*mark.confidence) : "") + "\n";
  }
  return text;
}

LandmarkFile parse_meshlab(std::string_view text) {
  if (text.find("<PickedPoints") == std::string_view::npos) {
    throw CommandError("it holds no <PickedPoints>", "save the points from MeshLab's PickPoints tool");
  }
  LandmarkFile file;
  static constexpr std::string_view opening = "<point ";
  for (size_t at; (at = text.find(opening)) != std::string_view::npos;) {
    text.remove_prefix(at + opening.size());
    const size_t end = element_end(text);
    const Cells attributes = attributes_of(text.substr(0, end));
    const auto active = attributes.find("active");
    if (active == attributes.end() || active->second != "0") {  // 0: a template's point that was not picked
      file.landmarks.push_back(landmark_of(attributes));
    }
    text.remove_prefix(end);
  }
  return file;
}

std::string format_meshlab(const LandmarkFile& file) {
  std::string text = "<!DOCTYPE PickedPoints>\n<PickedPoints>\n <DocumentData>\n";
  text += "  <DataFileName name=\"" + escaped(file.mesh) +
          "\"/>\n  <templateName name=\"\"/>\n </DocumentData>\n";
  for (const Landmark& mark : file.landmarks) {
    if (mark.absent()) continue;
    const Position p = position_of(mark);
    text += " <point x=\"" + text_of(p[0]) + "\" y=\"" + text_of(p[1]) + "\" z=\"" + text_of(p[2]) +
            "\" name=\"" + escaped(mark.name) + "\" active=\"1\"/>\n";
  }
  return text + "</PickedPoints>\n";
}

}  // namespace focal_cli
