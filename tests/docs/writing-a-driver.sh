# The driver of docs/writing-a-driver.md is saved from the page and led by fettle as the page says. Reference: the page.
"$HERE/run-page" "$HERE/../../docs/writing-a-driver.md"
