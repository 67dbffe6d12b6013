# Opens the report of a quick validation in a browser: every picture shows, nothing is fetched, the console stays silent.
# browser.sh PROGRAM
set -euo pipefail
command -v chromium >/dev/null || { echo "skipped: needs chromium"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() {
  printf 'failed: %s\n' "$*" >&2
  exit 1
}

"$1" validate --quick -o "$scratch" >"$scratch/table.txt" 2>"$scratch/log.txt" || fail "validate: $(tail -3 "$scratch/table.txt")"
grep -qE '(src|href)="(https?:)?//' "$scratch/report.html" && fail "the report fetches something"
# What the browser makes of its pictures, written where its answer shows it.
cp "$scratch/report.html" "$scratch/probe.html"
cat >>"$scratch/probe.html" <<'PROBE'
<script>
addEventListener("load", () => {
  const pictures = [...document.images];
  document.body.dataset.pictures = pictures.length;
  document.body.dataset.missing = pictures.filter(i => i.naturalWidth === 0).length;
});
</script>
PROBE
chromium --headless=new --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" --enable-logging=stderr --virtual-time-budget=10000 \
  --window-size=1180,2000 --screenshot="${ABBE_SCREENSHOT:-$scratch/report.png}" "file://$scratch/report.html" 2>"$scratch/browser.txt" >/dev/null
grep 'CONSOLE' "$scratch/browser.txt" && fail "the console has something to say"
answer=$(chromium --headless=new --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" --virtual-time-budget=10000 --dump-dom \
  "file://$scratch/probe.html" 2>/dev/null | grep -o '<body[^>]*>' | head -1)
[[ $answer == *'data-missing="0"'* ]] || fail "pictures are missing: $answer"
[[ $answer =~ data-pictures=\"([0-9]+)\" ]] && [ "${BASH_REMATCH[1]}" -ge 7 ] || fail "too few pictures: $answer"
echo "$answer"
