# Headings of Markdown get the anchors that GitHub gives them, which Doxygen does not know; with the file's name, for Doxygen
# wants them unique. Of links into other pages the page is left.
FNR == 1 { page = FILENAME; gsub(/[^A-Za-z0-9]/, "_", page); page = "page" page }
/^```/ { is_code = !is_code }
!is_code {
  gsub(/\]\(#/, "](#" page "-")
  gsub(/\.md#[a-z0-9-]+\)/, ".md)")
}
!is_code && /^##+ / {
  anchor = tolower($0)
  sub(/^#+ +/, "", anchor)
  gsub(/[^a-z0-9 -]/, "", anchor)
  gsub(/ /, "-", anchor)
  $0 = $0 " {#" page "-" anchor "}"
}
{ print }
