--- Scenario tests: what failed becomes the quickfix list.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- An entry of the quickfix list for a place in a file.
local function entry(uri, range, text, encoding)
  local name = vim.uri_to_fname(uri)
  local buffer = vim.fn.bufadd(name)
  vim.fn.bufload(buffer)
  local line = vim.api.nvim_buf_get_lines(buffer, range.start.line, range.start.line + 1, false)[1] or ''
  return {
    bufnr = buffer, lnum = range.start.line + 1, col = client.byte(line, range.start.character, encoding) + 1,
    text = text, type = 'E',
  }
end

--- Runs the scenarios of the buffer, or of the program in it; with `name` the one that is called so. The first line of a
--- failure has its place, the lines of its timing picture stand below.
function M.run(name)
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.expect(buffer)
  if not running then
    return
  end
  local argument = { uri = vim.uri_from_bufnr(buffer), names = name ~= '' and { name } or nil }
  local params = { command = 'rungwise.test.run', arguments = { argument } }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    if err then
      client.notify(err.message or vim.inspect(err), vim.log.levels.ERROR)
      return
    end
    local found = {}
    for _, file in ipairs(result.files) do
      for _, problem in ipairs(file.problems) do
        table.insert(found, entry(problem.uri, problem.range, problem.message, running.offset_encoding))
      end
      for _, scenario in ipairs(file.scenarios) do
        for _, failure in ipairs(scenario.failures) do
          local text = ('%s: %s'):format(scenario.name, failure.message)
          table.insert(found, entry(file.uri, failure.range, text, running.offset_encoding))
        end
        for _, line in ipairs(scenario.picture and vim.split(vim.trim(scenario.picture), '\n') or {}) do
          table.insert(found, { text = line })
        end
      end
    end
    vim.fn.setqflist({}, ' ', { title = t('Scenario tests'), items = found })
    if #found > 0 then
      vim.cmd('botright copen')
      vim.cmd.wincmd('p')
    else
      vim.cmd.cclose()
    end
    local level = #found > 0 and vim.log.levels.WARN or vim.log.levels.INFO
    if result.passed + result.failed == 0 and #found == 0 then
      client.notify(t('there are no scenario tests about this program'), vim.log.levels.WARN)
    else
      client.notify(t('%d scenarios passed, %d failed', result.passed, result.failed), level)
    end
  end, buffer)
end

return M
