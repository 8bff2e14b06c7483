# Sourced by avr/run and m4/run, which say in `device` what starts a board with a sketch, as a list of
# TOML without its brackets: a spring is recorded through the sketch `device`, fitted and controlled
# with `hysteron run`, and then the board is left alone with the sketch `standalone`.

say() { printf '%s\n' "$*" >&2; }
fail() { say "$*"; exit 1; }
# Whether an expression of numbers holds.
holds() { awk "BEGIN { exit !($1) }"; }

# A library for a model that does not matter: the sketch `device` is the same with any.
bare() { # BOARD
    "$here/../boards/model" 5 none > bare.json
    "$hysteron" export arduino bare.json -o bare --gains 1,10 --board "$1" > /dev/null
}

# Records MODEL.json. `lost_s`: a machine that has much to do may stop the board for a while.
record() { # MODEL DEVICE OPTIONS…
    awk 'BEGIN { print "time,drive"
        for (n = 0; n < 3600; n++)
            printf "%.2f,%.5f\n", n / 20, 0.34 * (1 - cos(0.013 * n) * exp(-n / 3000)) }' > profile.csv
    cat > record.toml << END
mode = "record"
log = "$1.csv"
device = { command = [$2] }
profile = { table = "profile.csv" }
safety = { lost_s = 2 }
END
    "$hysteron" run record.toml > /dev/null 2> record.log || fail "$(cat record.log)"
    "$hysteron" fit "$1.csv" --input drive --output output --time time "${@:3}" \
        --levels 10 --bootstrap 0 -o "$1.json" > fit.log 2>&1 || fail "$(cat fit.log)"
    # As plant.h has it.
    awk 'BEGIN { print "time,reference"
        for (n = 0; n < 2300; n++) { t = n / 20
            printf "%.2f,%.6f\n", t, 5 - 2 * cos(0.2 * t) * (1 + 0.3 * sin(0.047 * t)) } }' > reference.csv
}

gain() { sed "s/.*\"$1\":\([-0-9.e]*\).*/\1/" <<< "$gains"; }

# Controls with the gains of the library: `gains` is what `export arduino --json` said. GAIN is another
# gain, and LEARNER learns.
control() { # NAME DEVICE SECONDS
    local kind=inverse-pid learner=
    [ -z "${LEARNER:-}" ] || kind=adaptive-inverse-pid learner=", learner = \"$LEARNER\""
    cat > "$1.toml" << END
mode = "control"
log = "$1.csv"
duration_s = $3
device = { $2 }
reference = { table = "${REFERENCE:-reference.csv}" }
${LIMITS:-}
safety = { lost_s = 2 }
controller = { kind = "$kind", model = "${MODEL:-wire.json}", delay = 0, proportional = ${GAIN:-$(gain gain)}, integral_s = $(gain integral_s), derivative_s = $(gain derivative_s)$learner }
END
    "$hysteron" run "$1.toml" > "$1.said" 2> "$1.log"
}

# The error of a log: columns of time, wanted and position, and from when to when. By default from 25 s
# on, 20 s after the sketch alone began.
rmse() { awk -F, -v t="$2" -v r="$3" -v y="$4" -v from="${5:-25}" -v to="${6:-60}" \
    'NR > 1 && $t > from && $t < to { sum += ($r - $y) ^ 2; n++ } END { printf "%.4f", sqrt(sum / n) }' "$1"; }

# The rows of a chip in the table of errors, which must not differ by more than a tenth, or by MOST.
tracking() { # CHIP COMPUTER SERIAL BOARD [MOST]
    printf '| %s | %s | %s | %s |\n' "${@:1:4}"
    holds "$4 <= ${5:-1.1} * $2" || fail "$1: the loop on the board is worse, $4 and $2"
    [ -z "$3" ] || holds "$3 <= 1.2 * $2" || fail "$1: the serial line makes it worse"
}

# When the drive of a trace was above zero last, and for how long it was by then.
ends() { awk -F, '$4 > 0 { last = $1 } END { printf "%.2f", last }' "$1"; }
lasts() { awk -F, '$4 > 0 { if (!on) first = $1; on = 1; last = $1 } END { printf "%.2f", last - first }' "$1"; }

# A row in the table of faults: until when the drive was on, and what `run` said at last. With `for`
# as the last word, for how long it was on: when it begins depends on how busy this machine is.
row() { # CHIP WORDS NAME LATEST [for]
    local on said
    case ${5:-until} in
        until) on=$(ends "$3.trace") said=$on ;;
        for) on=$(lasts "$3.trace") said="for $on" ;;
    esac
    printf '| %s | %s | %s | %s |\n' "$1" "$2" "$said" "$(tail -n 1 "$3.log" | sed 's/^hysteron: //')"
    holds "$on <= $4" || fail "$1, $2: the drive stays on"
}

# Full drive from the start: a profile of a record.
hot() { # DEVICE
    awk 'BEGIN { print "time,drive"; for (n = 0; n < 500; n++) printf "%.2f,1\n", n / 20 }' > hot.csv
    cat > limit.toml << END
mode = "record"
log = "limit.csv"
device = { command = [$1] }
profile = { table = "hot.csv" }
safety = { lost_s = 2 }
END
    "$hysteron" run limit.toml > /dev/null 2> limit.log || true
    grep -q 'limit' limit.log || fail "limit: $(tail -n 1 limit.log)"
}

# The sketch alone on another actuator: as it was when its model was recorded, a fifth weaker, and a
# fifth stronger; with the fixed model, with a PI that is twice as strong, and with a learner.
# `alone SKETCH STRENGTH`, which the chip's script has, runs it for 60 s. Prints rows of a table.
learning() { # CHIP BOARD
    local sketch strength model row strong most
    model=$("$hysteron" export arduino quick.json -o fixed --name fixed --board "$2" --json)
    strong=$(gains=$model; awk "BEGIN { print 2 * $(gain gain) }"),$(gains=$model; gain integral_s)
    "$hysteron" export arduino quick.json -o strong --name strong --board "$2" --gains "$strong" > /dev/null
    "$hysteron" export arduino quick.json -o learns --name learns --board "$2" --adaptation > /dev/null
    for sketch in fixed strong learns; do
        compile_alone $sketch
        for strength in 1.0 0.8 1.2; do alone_on $sketch $strength; done &
    done
    wait
    for strength in 1.0 0.8 1.2; do
        row=()
        for sketch in fixed strong learns; do
            tail -n 2 $sketch$strength.txt | grep -q 'off:0 overruns:0' \
                || fail "$1, $sketch, $strength: $(tail -n 1 $sketch$strength.txt)"
            row+=("$(rmse $sketch$strength.trace 1 2 3 30 60)")
        done
        printf '| %s | model × %s | %s | %s | %s |\n' "$1" $strength "${row[@]}"
        [ $strength = 1.2 ] && most=0.95 || most=1.05
        holds "${row[2]} <= $most * ${row[0]}" || fail "$1: the learner brings nothing: ${row[*]}"
    done
}
