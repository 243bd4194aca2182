# Every sh block of the documentation runs as pasted; those that cannot run here are listed with the reason and what runs them
# instead. Pages whose commands take longer have cases of their own.
root=$(realpath "$HERE/../..")
elsewhere=(
    'README.md|make demo     #|builds everything and installs packages|.ci/run'
    'CONTRIBUTING.md|make test   |the tests themselves|.ci/run'
    'CONTRIBUTING.md|make fuzz |clang, and minutes|.ci/run'
    'docs/linuxcnc.md|fettle-stock-linuxcnc plan.json|needs LinuxCNC and root|tests/linuxcnc/patch.sh'
    "docs/studies.md|make -f pipelines/factorial.mk -j100|needs a cluster with Slurm|tests/studies/slurm.sh"
    "docs/studies.md|sudo apt-get install --no-install-recommends slurmctld|needs Slurm and root|tests/studies/slurm.sh"
)
for line in "${elsewhere[@]}"; do
    test -x "$root/${line##*|}" || test -e "$root/${line##*|}" # what runs them is there
done

pages=$(cd "$root" && ls README.md CONTRIBUTING.md samples/README.md docs/*.md docs/methods/*.md)
unset MAKEFLAGS MFLAGS # a make that a page begins is not of this one
for page in $pages; do
    case $page in
    docs/tutorial.md | docs/tutorial-robot.md | docs/adding-a-tool.md | docs/writing-a-driver.md) test -e "$HERE/$(basename "$page" .md).sh" && continue ;;
    docs/methods/README.md) ;;
    docs/methods/*) grep -qE "^follow .*\b$(basename "$page" .md)( |\$)" "$HERE"/methods-*.sh && continue ;;
    esac
    skip=()
    for line in "${elsewhere[@]}"; do
        IFS='|' read -r where begin _ <<<"$line"
        if [ "$where" = "$page" ]; then skip+=(--skip "$begin"); fi
    done
    rm -rf here
    mkdir here
    cp -r "$SAMPLES" "$root/pipelines" here
    chmod -R u+w here
    (cd here && "$HERE/run-page" "$root/$page" "${skip[@]}")
done

# Commands within sentences: each option of a tool is one that its --help knows, each study a target of its make file.
cd "$root"
spans() { grep -ohE '`'"$1"'[^`]*`' $pages | tr -d '`' | sort -u; }
spans 'fettle-[a-z-]+ [^`]*--' | while read -r tool words; do
    case $tool in fettle-gantry-linuxcnc | fettle-step) continue ;; esac # built where LinuxCNC's, OpenCASCADE's headers are
    help=$("$tool" --help)
    for option in $(grep -oE '(^| )--[a-z][a-z0-9-]*' <<<"$words"); do
        grep -qE -- "$option( |,|\$)" <<<"$help" || { echo "$tool has no option $option"; exit 1; }
    done
done
spans 'make -f ' | while read -r _ _ file words; do
    words=$(sed -E 's/-j[0-9]*//; s/[A-Z]+=[^ ]*//g' <<<"$words")
    for target in $words; do
        grep -qE "^([a-z%$().-]+ )*$target( [a-z%$().-]+)*:" "$file" || { echo "$file has no target $target"; exit 1; }
    done
    test -e "tests/studies/$(basename "$file" .mk).sh" || grep -q "$file" .ci/run tests/studies/*.sh Makefile pipelines/*.mk
done
