# The driver of docs/writing-a-driver.md is saved from the page and commanded by fettle as on the page. Reference: the page.
"$HERE/run-page" "$HERE/../../docs/writing-a-driver.md"
