% For valgrind: every path through both functions, with errors on the way. At the end the functions
% are cleared.
function memory()
model = [tempname() '.json'];
whole = [tempname() '.json'];
tidy = onCleanup(@() delete(model, whole));
write_whole(whole);
write_model(model, '[1, 0.5, 1, 0, 0.5, 1]');
for round = 1:2
    for name = {'sf_MKP', 'sf_Inverse_MKP'}
        call = name{1};
        block = feval(call, 'open', model);
        feval(call, block, [12 13 11.5]);
        feval(call, 'restore', block, feval(call, 'save', block));
        feval(call, 'info', model);
        wrong = {{block, NaN}, {'/no/such/model.json', 1}, {model, 1, 'load', 2}, ...
            {model, 1, 'lode', 2}, {block + 1, 1}};
        for k = 1:numel(wrong)
            try
                feval(call, wrong{k}{:});
                error('hysteron:test', 'accepted');
            catch fault
                assert(~strcmp(fault.identifier, 'hysteron:test'));
            end
        end
    end
    timed = {'time', [0 1 2], 'load', 100, 'start', 'on'};
    sf_MKP(whole, [0.1 0.5 0.3], timed{:});
    sf_Inverse_MKP(whole, [1 0.5 0], timed{:}, 'drive_range', [0 1], 'horizon', 0.1);
    sf_Inverse_MKP(model, [12 13 11.5], 'policy', 'anticipate', 'tolerance', 0.1);
    clear sf_MKP sf_Inverse_MKP % one block of each is still open
end
printf('memory: done\n');
end
