# No dead link between the pages: the file is there, and so is the heading that a # names.
cd "$HERE/../.."
status=0
for page in README.md CONTRIBUTING.md samples/README.md docs/*.md docs/methods/*.md; do
    for link in $(sed '/^```/,/^```/d' "$page" | grep -oE '\]\([^)]+\)' | sed 's/^](//; s/)$//'); do
        case $link in http*) continue ;; esac
        file=$(dirname "$page")/${link%%#*}
        [ "${link%%#*}" ] || file=$page
        [ -e "$file" ] || { echo "$page: $link: no such file"; status=1; continue; }
        case $link in *#*)
            sed -nE 's/^#+ //p' "$file" | tr '[:upper:]' '[:lower:]' | sed "s/[^a-z0-9 _-]//g; s/ /-/g" |
                grep -qxF -- "${link#*#}" || { echo "$page: $link: no such heading"; status=1; } ;;
        esac
    done
done
exit $status
