/* The functions for saved states, which the standards have in common but for names: the layers
 * include this once, with the names as macros. */

STATUS STATES(Get)(INSTANCE c, STATE *state)
{
    NO_INSTANCE(c);
    if (!state) return answer(c, "save a state", "there is no place for it");
    if (!*state) *state = malloc(sizeof(block_run));
    if (!*state) return answer(c, "save a state", "there is no memory");
    block_copy(*state, &((block *)c)->run);
    return answer(c, "save a state", NULL);
}

STATUS STATES(Set)(INSTANCE c, STATE state)
{
    NO_INSTANCE(c);
    if (!state) return answer(c, "restore a state", "there is none");
    block_copy(&((block *)c)->run, state);
    return answer(c, "restore a state", NULL);
}

STATUS STATES(Free)(INSTANCE c, STATE *state)
{
    NO_INSTANCE(c);
    if (state) {
        free(*state);
        *state = NULL;
    }
    return answer(c, "free a state", NULL);
}

STATUS SIZED(INSTANCE c, STATE state, size_t *size)
{
    NO_INSTANCE(c);
    if (!state || !size) return answer(c, "size of a state", "there is none");
    *size = sizeof(block_saved);
    return answer(c, "size of a state", NULL);
}

STATUS SERIALISE(INSTANCE c, STATE state, BYTE bytes[], size_t size)
{
    block_saved saved;
    const char *wrong;
    NO_INSTANCE(c);
    wrong = !state || !bytes ? "there is no state" : block_save(state, &saved);
    if (!wrong && size < sizeof saved) wrong = "there is no room for the bytes";
    if (!wrong) memcpy(bytes, &saved, sizeof saved);
    return answer(c, "serialise a state", wrong);
}

STATUS DESERIALISE(INSTANCE c, const BYTE bytes[], size_t size, STATE *state)
{
    block_saved saved;
    block_run *run;
    const char *wrong;
    NO_INSTANCE(c);
    if (!bytes || !state || size != sizeof saved)
        return answer(c, "deserialise a state", "the bytes are cut");
    memcpy(&saved, bytes, sizeof saved);
    run = malloc(sizeof *run);
    wrong = run ? block_restore(run, &saved) : "there is no memory";
    if (wrong) free(run);
    else *state = run;
    return answer(c, "deserialise a state", wrong);
}
