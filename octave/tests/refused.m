% The call raises an error with this identifier, and with these words in its message.
function refused(identifier, call, words)
found = '';
try
    call();
catch fault
    found = fault.identifier;
    if nargin > 2
        assert(~isempty(strfind(fault.message, words)), fault.message);
    end
end
assert(strcmp(found, identifier), '%s: %s instead of %s', func2str(call), found, identifier);
end
