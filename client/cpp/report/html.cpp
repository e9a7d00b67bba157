#include "client/cpp/report/html.h"

#include "client/cpp/plot/svg.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kPageStyle[] = R"(
body { font: 15px/1.5 "Helvetica Neue", Arial, sans-serif; color: #222; margin: 2em auto; max-width: 1100px; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #ddd; }
table { border-collapse: collapse; margin: 1em 0; }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #e4e4e4; }
th:first-child, td:first-child { text-align: left; }
td.hash { font-family: monospace; font-size: .85em; word-break: break-all; text-align: left; }
pre { font-size: 12px; line-height: 1.35; overflow-x: auto; background: #f7f7f7; padding: 1em; }
figure { margin: 1em 0; } svg { max-width: 100%; height: auto; }
.verdict { display: inline-block; min-width: 7em; padding: .1em .6em; border-radius: 3px; font-weight: bold; text-align: center; }
.holds { background: #d9efe4; color: #0b4f36; } .partly { background: #fbeccb; color: #6b4400; }
.does-not-hold { background: #f8d9cf; color: #7a2300; } .open { background: #e8e8e8; color: #333; }
.finding { margin: 1.4em 0; } .finding p { margin: .3em 0; } .rule { color: #555; }
@media print { pre { white-space: pre-wrap; } h2 { break-after: avoid; } }
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

std::string html_page(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         xml_escaped(title) + "</title>\n<style>" + kPageStyle + "</style>\n</head>\n<body>\n<h1>" +
         xml_escaped(title) + "</h1>\n" + body + "</body>\n</html>\n";
}

std::string html_paragraph(const std::string& text) { return "<p>" + xml_escaped(text) + "</p>\n"; }

std::string html_chapter(const std::string& text) { return "<h2>" + xml_escaped(text) + "</h2>\n"; }

std::string html_preformatted(const std::string& text) {
  std::string out;
  for (const std::string& line : split(text, '\n')) out += xml_escaped(line) + "\n";
  while (out.ends_with("\n\n")) out.pop_back();
  return "<pre>" + out + "</pre>\n";
}

std::string html_closed_part(const std::string& title, const std::string& html) {
  return "<details><summary>" + xml_escaped(title) + "</summary>\n" + html + "</details>\n";
}

std::string html_figure(const std::string& svg, const std::string& prefix,
                        const std::string& label) {
  const std::string own = replaced(svg, " id=\"", " id=\"" + prefix);
  return "<figure role=\"img\" aria-label=\"" + xml_escaped(label) + "\">\n" +
         replaced(own, "url(#", "url(#" + prefix) + "</figure>\n";
}

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) {
    out += std::string("<") + tag + ">" + xml_escaped(cell) + "</" + tag + ">";
  }
  return out + "</tr>\n";
}

}  // namespace tribodyn::client
