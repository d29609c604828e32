# What may stand behind --set, by the manual of case files on standard input (sphode info case).
#   -v typed=groups.water.e    what is there already: keys behind it, with "." where more follow, "=" where a value does
#   -v typed=search=           with a value begun: the words it may have
#   -v file=case.yml           names of groups, events, parameters are read from it
# Names below `wanted` ("groups", "output.monitors") in the file.
function names(wanted,    line, found, top, indent, key, path, rest) {
  while (file != "" && (getline line < file) > 0) {
    if (!match(line, /^ *[A-Za-z0-9_.-]+:/)) continue
    key = substr(line, 1, RLENGTH - 1); rest = substr(line, RLENGTH + 1)
    indent = match(key, /[^ ]/); key = substr(key, indent)
    while (top && indents[top] >= indent) top--
    path = top ? paths[top] : ""
    if (path == wanted) found = found " " key
    indents[++top] = indent; paths[top] = path (path == "" ? "" : ".") key
    if (paths[top] == wanted && rest ~ /^ *\{/) found = found " " flow(rest)
  }
  if (file != "") close(file)
  return found
}
# Keys of {a: ..., b: {...}}, the outer ones.
function flow(text,    k, c, depth, word, found) {
  for (k = 1; k <= length(text); k++) {
    c = substr(text, k, 1)
    if (index("{[", c)) depth++
    else if (index("}]", c)) depth--
    if (depth != 1) continue
    if (c == ":") { found = found " " word; word = "" }
    else if (index("{,", c)) word = ""
    else if (c ~ /[A-Za-z0-9_.-]/) word = word c
    else if (c != " ") word = ""
  }
  return found
}
/^## / { mapping = $2; next }
/^\| `/ {
  n = split($0, cell, / *\| */)
  key = cell[2]; gsub(/`/, "", key)
  keys[mapping] = keys[mapping] " " key
  type[mapping, key] = cell[3]
  if (match(cell[3], /#[^)]+/)) link[mapping, key] = substr(cell[3], RSTART + 1, RLENGTH - 1)
  if (cell[3] ~ /word/) { words[mapping, key] = cell[4]; gsub(/[`,]/, "", words[mapping, key]) }
}
END {
  value = typed ~ /=/
  sub(/=.*/, "", typed)
  n = split(typed, part, ".")
  if (typed == "") n = 1
  at = "case"; base = ""; path = ""
  for (k = 1; k < n + value; k++) {
    key = part[k]; kind = type[at, key]
    if (kind == "") exit
    last = at; base = base key "."; path = path (path == "" ? "" : ".") key
    if (kind ~ /^(names|list)/) {
      if (++k == n && !value) {
        m = split(kind ~ /^names/ ? names(path) : "0", name, " ")
        for (i = 1; i <= m; i++) print base name[i] (link[at, key] == "" ? "=" : ".")
        exit
      }
      base = base part[k] "."; path = path "." part[k]
    }
    at = link[at, key]
  }
  if (value) { m = split(words[last, key], word, " "); for (i = 1; i <= m; i++) print word[i]; exit }
  m = split(keys[at], name, " ")
  for (i = 1; i <= m; i++) print base name[i] (link[at, name[i]] == "" && type[at, name[i]] !~ /^names/ ? "=" : ".")
}
