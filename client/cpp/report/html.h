#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// Returns a page (HTML) with this body that needs no other file, no script and no network.
std::string html_page(const std::string& title, const std::string& body);

/// Returns a cell-by-cell escaped row of a table; `tag` is "td" or "th".
std::string html_row(const std::vector<std::string>& cells, const char* tag);
std::string html_paragraph(const std::string& text);
std::string html_chapter(const std::string& text);
/// Returns the lines of a text report in a fixed pitch.
std::string html_preformatted(const std::string& text);
/// Returns a part of the page that is closed until a reader opens it.
std::string html_closed_part(const std::string& title, const std::string& html);
/// Returns an SVG picture as a part of a page. The ids of its elements get a prefix of their own:
/// all pictures of a page share one space of ids.
std::string html_figure(const std::string& svg, const std::string& prefix,
                        const std::string& label);

}  // namespace tribodyn::client
