#!/bin/sh
# The manual page, for scdoc: what stands here, and each command's own --help. Usage: man.sh DELBM VERSION.
set -eu
delbm=$1

# the help of a command as it is, one line a line
verbatim() {
  echo '```'
  "$delbm" "$@" --help
  echo '```'
}

cat <<EOF
delbm(1) "delbm $2"

# NAME

delbm - flows with discs in them, in two dimensions, by the lattice Boltzmann method

# SYNOPSIS

*delbm* _COMMAND_ [_ARGUMENT_]...

# DESCRIPTION

EOF
verbatim
"$delbm" --help | awk '/^commands/ {on = 1; next} /^$/ {on = 0} on {print $1}' | while read -r command; do
  printf '\n# %s\n\n' "$(echo "$command" | tr '[:lower:]' '[:upper:]')"
  verbatim "$command"
done
cat <<EOF

# CASES

A case is a YAML file. *delbm run --help-keys* lists every key with its meaning, unit, range and default.

# FILES

A run writes _case.yaml_, _particles.csv_, _run.json_ and, if the case asks for them, _series.csv_, _fields.h5_ with
_fields.xdmf_, pictures and checkpoints into its folder.

# ENVIRONMENT

_OMP_NUM_THREADS_ sets the number of threads; results do not depend on it. _OMP_WAIT_POLICY_ and _GOMP_SPINCOUNT_
decide how threads wait.
EOF
