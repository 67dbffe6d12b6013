# Command lines complete under bash.
. "$(dirname "$0")/check.sh"
set +eu  # as an interactive shell
COMP_WORDBREAKS=$' \t\n"\'@><=;|&(:'
export ABBE_DATA=$ABBE_SOURCE/data
PATH=$ABBE_BUILD/cli:$PATH
source <(abbe help --format bash)

completes() {  # LINE WANTED: the answers, sorted, in one line
  COMP_LINE=$1 COMP_POINT=${#1} COMPREPLY=()
  _abbe
  equal "completion of \"$1\"" "$(printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | paste -sd ' ')" "$2"
}

contains "completion is set up" "$(complete -p abbe)" "-F _abbe abbe"
completes "abbe ren" "render"
completes "abbe query br" "brewster"
completes "abbe query ior N-B" "N-BAF10 N-BAK4 N-BK7"
completes "abbe query ior N-BK7 --a" "--arrays --at"
completes "abbe query ior N-BK7 --at " ""
completes "abbe query --list il" "illuminant"
completes "abbe query color --illuminant D6" "D60 D65"
completes "abbe query color --reflectance Blue" 'Blue\ Sky'
completes "abbe render --integrator " "adjoint-brute auto bdpt light path photon-brute photon-map ppm sppm vcm"
completes "abbe render --integrator=l" "light"
completes "abbe bench --int" "--integrator"
completes "abbe render --layers " "bounces lights"
completes "abbe render --spp 4 --e" "--error --explain --exposure-of"
completes "abbe render --integrator light --sta" "--stats"
completes "abbe --vers" "--version"
completes "abbe help comp" "compare"
completes "abbe nonsense --" "--help --version"

cd "$scratch"
mkdir folder
touch a.json b.json c.exr d.csv e.abbepart
completes "abbe render " "a.json b.json folder"
completes "abbe lens " "a.json b.json folder"
completes "abbe render a.json -o " "c.exr e.abbepart folder"
completes "abbe render a.json --stats " "a.json b.json folder"
completes "abbe merge e.abbepart " "e.abbepart folder"
completes "abbe compare c.exr c" "c.exr"
completes "abbe calibrate --camera ./" "./d.csv ./folder"
completes "abbe calibrate -o f" "folder"

# Bash takes what follows the last colon for the word.
name=$(abbe query --list reflectance | grep -m 1 :)
completes "abbe query color --reflectance ${name%?}" "$(abbe query --list reflectance | grep "^${name%?}" | LC_ALL=C sort | sed "s/^${name%:*}://" | paste -sd ' ')"
[ -n "$name" ] || fail "no name with a colon to try"
